#pragma once

#include <array>

namespace isorim::geometry {

/// One node of the Gauss-Kronrod pair of 7 and 15 points on [-1, 1]; the nodes are symmetric. Gauss weight 0 where
/// the 7-point rule has no node.
struct KronrodNode {
  double node;
  double kronrod_weight;
  double gauss_weight;
};

/// The nodes from 0 on; those below 0 mirror them.
inline constexpr std::array<KronrodNode, 8> kronrod_nodes{{
    {0.0, 0.20948214108472782801, 0.41795918367346938776},
    {0.2077849550078984676, 0.20443294007529889241, 0.0},
    {0.40584515137739716691, 0.19035057806478540991, 0.38183005050511894495},
    {0.58608723546769113029, 0.16900472663926790283, 0.0},
    {0.74153118559939443986, 0.14065325971552591875, 0.2797053914892766679},
    {0.86486442335976907279, 0.10479001032225018384, 0.0},
    {0.94910791234275852453, 0.063092092629978553291, 0.12948496616886969327},
    {0.99145537112081263921, 0.022935322010529224964, 0.0},
}};

}  // namespace isorim::geometry
