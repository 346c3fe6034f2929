#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/topology/orientation.h"
#include "io/case/case_file.h"
#include "solver/bem/field_space.h"
#include "solver/bem/problem.h"

/// From the sections of a case to what the solver takes.
namespace isorim::io {

/// Tells which of a case's conditions holds where. One with "where" goes before one for named patches, and that before
/// one for all.
template <int Dim>
class ConditionSelector {
 public:
  ConditionSelector(const CaseFile& file, const geometry::Boundary<Dim>& boundary);

  /// Index into the case's conditions for an element of a patch, by the point and the outward normal in its middle; -1
  /// if there is none. Throws InputError, naming both, if two conditions of the same rank meet.
  int select(int patch, const geometry::Point<Dim>& point, const geometry::Vector<Dim>& normal);

 private:
  /// A condition with an expression for the elements on some patches.
  struct Candidate {
    int condition = 0;
    /// 2: selected by "where"; 1: by name; 0: all.
    int rank = 0;
    quadrature::Integrand<Dim> selection;
    /// Empty: all.
    std::vector<char> on_patch;
  };
  bool holds(const Candidate& candidate, int patch, const geometry::Point<Dim>& point,
             const geometry::Vector<Dim>& normal) const;

  const CaseFile* file_;
  const geometry::Boundary<Dim>* boundary_;
  std::vector<Candidate> candidates_;
};

template <int Dim>
struct BoundaryValueProblem {
  solver::FieldSpace<Dim> space;
  solver::Problem<Dim> problem;
  /// For each of problem.conditions the index of the case's condition (one for several planes of symmetry makes
  /// several).
  std::vector<int> case_condition;
  std::vector<std::string> warnings;
};

/// What a case says of its boundary, for any space on it. The arguments of the constructor must outlive the object.
template <int Dim>
class ProblemStatement {
 public:
  /// Throws GeometryError for a boundary that is not closed.
  ProblemStatement(const CaseFile& file, const geometry::OrientedBoundary<Dim>& boundary);

  /// Degree, bisections and where conditions keep functions apart: elements of a space have the index of the case's
  /// condition as group.
  solver::DiscretisationOptions<Dim> discretisation() const;
  /// The problem on a space of that discretisation, refined further or not. Throws InputError, naming the patches, for
  /// parts of the boundary without a condition; for conditions that meet, or select nothing; for a component along the
  /// normal where the boundary is not flat; and as the solver does.
  BoundaryValueProblem<Dim> on(solver::FieldSpace<Dim> space) const;

 private:
  const CaseFile* file_;
  const geometry::OrientedBoundary<Dim>* boundary_;
  std::shared_ptr<ConditionSelector<Dim>> selector_;
};

}  // namespace isorim::io
