#include "io/picture/shown_field.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkPointData.h>

#include "geometry/errors.h"
#include "io/case/complaints.h"

namespace isorim::io::picture {
namespace {

/// What describes the cells and is no field.
bool is_of_the_shape(const std::string& name) {
  constexpr std::array<const char*, 4> names{"RationalWeights", "HigherOrderDegrees", "vtkGhostType", "Normals"};
  return std::any_of(names.begin(), names.end(), [&](const char* other) { return name == other; });
}

/// Those that the file tells; x, y, z for vectors, the entries of tensors as VTK orders them, else numbers.
std::vector<std::string> component_names(vtkDataArray* array) {
  const int count = array->GetNumberOfComponents();
  const std::vector<std::string> axes{"x", "y", "z"};
  const std::vector<std::string> symmetric{"xx", "yy", "zz", "xy", "yz", "xz"};
  std::vector<std::string> names;
  for (int c = 0; c < count; ++c) {
    const auto k = static_cast<std::size_t>(c);
    if (array->HasAComponentName() && array->GetComponentName(c) != nullptr) {
      names.emplace_back(array->GetComponentName(c));
    } else if (count == 3) {
      names.push_back(axes[k]);
    } else if (count == 6) {
      names.push_back(symmetric[k]);
    } else if (count == 9) {
      names.push_back(axes[k / 3] + axes[k % 3]);
    } else {
      names.push_back(std::to_string(c));
    }
  }
  return names;
}

/// Whether the entries are those of a vector, so that it has a magnitude.
bool is_vector(vtkDataArray* array) {
  return component_names(array) == std::vector<std::string>{"x", "y", "z"};
}

int component_of(vtkDataArray* array, const FieldChoice& choice) {
  std::vector<std::string> names = component_names(array);
  if (names.size() == 1 && choice.component.empty()) return 0;
  if (is_vector(array) && (choice.component.empty() || choice.component == "magnitude")) return -1;
  const auto found = std::find(names.begin(), names.end(), choice.component);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  int number = -1;
  const char* end = choice.component.data() + choice.component.size();
  if (std::from_chars(choice.component.data(), end, number).ptr == end && number >= 0 &&
      number < array->GetNumberOfComponents()) {
    return number;
  }
  if (is_vector(array)) names.insert(names.begin(), "magnitude");
  const std::string found_text =
      choice.component.empty() ? "no component" : fmt::format("the component \"{}\"", choice.component);
  throw InputError(fmt::format("field \"{}\": found {}{}; expected one of {}", choice.name, found_text,
                               choice.component.empty() ? "" : did_you_mean(choice.component, names),
                               fmt::join(names, ", ")));
}

void describe(vtkDataSetAttributes* data, std::vector<std::string>& list) {
  for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
    vtkDataArray* array = data->GetArray(i);
    if (array == nullptr || array->GetName() == nullptr || is_of_the_shape(array->GetName())) continue;
    if (array->GetNumberOfComponents() == 1) {
      list.emplace_back(array->GetName());
    } else {
      list.push_back(fmt::format("{} ({})", array->GetName(), fmt::join(component_names(array), ", ")));
    }
  }
}

}  // namespace

int ShownField::components() const {
  return array->GetNumberOfComponents();
}

double ShownField::reduced(const double* tuple) const {
  return component < 0 ? std::hypot(tuple[0], tuple[1], tuple[2]) : tuple[component];
}

bool has_field(vtkDataSet* data, const std::string& name) {
  if (is_of_the_shape(name)) return false;
  return data->GetPointData()->GetArray(name.c_str()) != nullptr ||
         data->GetCellData()->GetArray(name.c_str()) != nullptr;
}

std::optional<ShownField> find_field(vtkDataSet* data, const FieldChoice& choice) {
  if (!has_field(data, choice.name)) return std::nullopt;
  vtkDataArray* of_points = data->GetPointData()->GetArray(choice.name.c_str());
  vtkDataArray* array = of_points != nullptr ? of_points : data->GetCellData()->GetArray(choice.name.c_str());
  return ShownField{array, of_points == nullptr, component_of(array, choice)};
}

std::vector<std::string> described_fields(vtkDataSet* data) {
  std::vector<std::string> list;
  describe(data->GetPointData(), list);
  describe(data->GetCellData(), list);
  return list;
}

std::string legend_title(const FieldChoice& choice) {
  return choice.component.empty() || choice.component == "magnitude" ? choice.name
                                                                     : choice.name + " " + choice.component;
}

}  // namespace isorim::io::picture
