#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/picture/picture.h"

class vtkDataArray;
class vtkDataSet;

namespace isorim::io::picture {

/// The field of a data set that a picture shows, reduced to one number.
struct ShownField {
  vtkDataArray* array = nullptr;
  /// Of the cells, else of the points.
  bool is_of_cells = false;
  /// -1: the magnitude.
  int component = 0;

  int components() const;
  /// components() numbers to the one that is shown.
  double reduced(const double* tuple) const;
};

bool has_field(vtkDataSet* data, const std::string& name);

/// Absent if the data set has no field of the name. Throws InputError if the component is missing or unknown.
std::optional<ShownField> find_field(vtkDataSet* data, const FieldChoice& choice);

/// "name" or "name (x, y, z)" for each field, those of points first.
std::vector<std::string> described_fields(vtkDataSet* data);

/// What the legend says: "stress xx", "displacement" (its magnitude).
std::string legend_title(const FieldChoice& choice);

}  // namespace isorim::io::picture
