#pragma once

#include <functional>
#include <span>
#include <vector>

#include "geometry/vocabulary.h"
#include "solver/bem/patch_space.h"

namespace isorim::solver {

/// Chooses collocation points for the functions that have none (has_point[f] == 0) among candidates in the elements
/// where they live: approximate Fekete points, by the pivots of a QR factorisation of the candidates' values, made
/// orthogonal to those at the points that neighbouring functions have already (A. Sommariva & M. Vianello, Comput.
/// Math. Appl. 57, 2009). It is done for some dozens of neighbouring functions at a time, so the cost grows with their
/// number. candidates(element): places in its unit cell.
///
/// Returns functions that cannot be told from the others at any candidates (to `indistinct`), so that leaving them out
/// lets the others have points; the points are incomplete then. Empty: all have points.
template <int Dim>
std::vector<int> choose_points(PatchSpace<Dim>& patch, std::vector<char> has_point,
                               const std::function<std::vector<geometry::Point<Dim - 1>>(int element)>& candidates,
                               double indistinct);

/// The same where that cannot be: throws NumericalError if there are such functions.
template <int Dim>
void require_points(PatchSpace<Dim>& patch, std::vector<char> has_point,
                    const std::function<std::vector<geometry::Point<Dim - 1>>(int element)>& candidates);

/// Values of an element's functions at a place but for the common denominator: sum of Bernstein polynomials.
template <int Dim>
void numerators(const PatchSpace<Dim>& patch, int element, const geometry::Point<Dim - 1>& place,
                std::span<double> values);

}  // namespace isorim::solver
