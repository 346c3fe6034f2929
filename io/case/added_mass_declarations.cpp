#include <fmt/format.h>

#include "io/case/added_mass_keys.h"
#include "solver/bem/edge_grading.h"
#include "solver/bem/field_space.h"

namespace isorim::io {

template <>
const Schema<AddedMassKeys>& schema<AddedMassKeys>() {
  using Discretisation = solver::DiscretisationOptions<3>;
  static const auto declared =
      Schema<AddedMassKeys>("added_mass",
                            "The added masses of a closed solid in potential flow, 6 x 6, by boundary elements. Of a "
                            "hull at a draught those of the double body. Results in results.json.")
          .key("water_density", &AddedMassKeys::water_density,
               {.text = "Of the fluid, per volume.", .range = Range::above(0)})
          .key("draught", &AddedMassKeys::draught,
               {.text = "The part of the solid under this level and its mirror image; the numbers are for the part. If "
                        "absent, the whole solid in an unbounded fluid.",
                .unit = "length",
                .range = Range::above(0)})
          .key("baseline", &AddedMassKeys::baseline,
               {.text = "z from which the draught counts; that of a hull's table, else of the lowest point, if absent.",
                .unit = "length"})
          .key("centre", &AddedMassKeys::centre,
               {.text = "The point that moves, and about which the solid turns; the origin, at a draught the point "
                        "over it in the water, if absent.",
                .unit = "length"})
          .key("degree", &AddedMassKeys::degree,
               {.text = "Of the functions.", .range = Range::between(1, Discretisation::max_degree)})
          .key("refine", &AddedMassKeys::refine,
               {.text = "Bisections of every knot span; without the last one the errors are estimated.",
                .range = Range::between(1, Discretisation::max_refine)})
          .key("edge_layers", &AddedMassKeys::edge_layers,
               {.text = "Layers of elements towards sharp edges, each a quarter as wide as the one before.",
                .range = Range::between(0, solver::EdgeGrading::max_layers)})
          .choice("method", &AddedMassKeys::method,
                  {{"auto", SolveMethodKind::automatic},
                   {"dense", SolveMethodKind::dense},
                   {"compressed", SolveMethodKind::compressed}},
                  {.text = "As in [solve]."})
          .key("tolerance", &AddedMassKeys::tolerance,
               {.text = "Relative error that integrals, compression and iterations aim at.",
                .range = {.least = 0, .most = 0.1, .least_is_open = true}})
          .check([](const AddedMassKeys& keys, const KeyPlace& where, Complaints& complaints) {
            if (keys.centre && !keys.centre->values.empty() && keys.centre->values.size() != 3)
              complaints.add(keys.centre->where,
                             fmt::format("found {} coordinates; expected 3", keys.centre->values.size()));
            if (keys.baseline && !keys.draught) complaints.add(where, "a \"baseline\" needs a \"draught\"");
          });
  return declared;
}

std::vector<std::string> added_mass_quantity_names() {
  return {"added_mass.matrix", "added_mass.displaced_mass", "added_mass.surge", "added_mass.sway",
          "added_mass.heave",  "added_mass.roll",           "added_mass.pitch", "added_mass.yaw"};
}

}  // namespace isorim::io
