#include "io/picture/picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkPointData.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"
#include "io/picture/data_file.h"
#include "io/picture/drawable.h"
#include "io/picture/sheet.h"

namespace isorim::io::picture {
namespace {

struct Input {
  std::string label;
  vtkSmartPointer<vtkDataSet> data;
  std::optional<ShownField> field;
};

/// What `work` complains of is told with the label.
template <class Work>
auto labelled(const std::string& label, const Work& work) {
  try {
    return work();
  } catch (Error& error) {
    error.add_context(label);
    throw;
  }
}

std::vector<Input> read_inputs(const std::vector<PictureInput>& files) {
  std::vector<Input> inputs;
  for (const PictureInput& input : files) {
    inputs.push_back({input.label, labelled(input.label, [&] { return read_data_file(input.file); }), std::nullopt});
  }
  if (inputs.empty()) throw InputError("there is nothing to draw: found no input file");
  return inputs;
}

void find_fields(std::vector<Input>& inputs, const FieldChoice& choice) {
  std::set<std::string> known;
  bool is_found = false;
  for (Input& input : inputs) {
    input.field = labelled(input.label, [&] { return find_field(input.data, choice); });
    is_found = is_found || input.field;
    for (const std::string& name : described_fields(input.data)) known.insert(name);
  }
  if (is_found) return;
  const std::string expected =
      known.empty() ? "nothing, since there are no fields" : fmt::format("one of {}", fmt::join(known, ", "));
  throw InputError(fmt::format("{}: found no field \"{}\"; expected {}", inputs.front().label, choice.name, expected));
}

double size_of(const std::vector<Input>& inputs) {
  std::array<double, 3> lower{};
  std::array<double, 3> upper{};
  lower.fill(std::numeric_limits<double>::infinity());
  upper.fill(-std::numeric_limits<double>::infinity());
  for (const Input& input : inputs) {
    std::array<double, 6> box{};
    input.data->GetBounds(box.data());
    for (std::size_t d = 0; d < 3; ++d) {
      lower[d] = std::min(lower[d], box[2 * d]);
      upper[d] = std::max(upper[d], box[2 * d + 1]);
    }
  }
  const double size = std::hypot(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]);
  if (!std::isfinite(size)) {
    throw InputError(fmt::format("{}: holds points that are not finite", inputs.front().label));
  }
  return size;
}

/// The ends of the values that are drawn; apart even if all are equal.
std::array<double, 2> value_range(const std::vector<Drawable>& drawables, const FieldChoice& choice) {
  std::array<double, 2> range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Drawable& drawable : drawables) {
    if (!drawable.has_field) continue;
    for (vtkPolyData* part : {drawable.faces.Get(), drawable.curves.Get(), drawable.points.Get()}) {
      auto* shown = vtkDoubleArray::SafeDownCast(part->GetPointData()->GetArray("shown"));
      for (vtkIdType i = 0; i < shown->GetNumberOfTuples(); ++i) {
        const double value = shown->GetValue(i);
        if (!std::isfinite(value)) continue;
        range = {std::min(range[0], value), std::max(range[1], value)};
      }
    }
  }
  if (range[0] > range[1]) throw InputError(fmt::format("field \"{}\": has no finite value", choice.name));
  // Rounding alone is neither a value nor a variation.
  const double width = range[1] - range[0];
  for (double& end : range) {
    if (std::abs(end) < 1e-10 * width) end = 0.0;
  }
  const double middle = 0.5 * (range[0] + range[1]);
  const double least = middle == 0.0 ? 1e-300 : 1e-10 * std::abs(middle);
  if (width < least) {
    const double half = middle == 0.0 ? 0.5 : 0.05 * std::abs(middle);
    range = {middle - half, middle + half};
  }
  if (choice.map == ColourMap::coolwarm) {
    const double most = std::max(std::abs(range[0]), std::abs(range[1]));
    range = {-most, most};
  }
  return range;
}

}  // namespace

void check_options(const PictureOptions& options, const std::filesystem::path& output) {
  if (output.extension() != ".png") {
    throw InputError(fmt::format("cannot write '{}': found the extension \"{}\", expected .png", output.string(),
                                 output.extension().string()));
  }
  constexpr int most = 8192;
  if (std::min(options.width, options.height) < 32 || std::max(options.width, options.height) > most) {
    throw InputError(fmt::format("found a picture of {} x {} pixels; expected 32 to {} either way", options.width,
                                 options.height, most));
  }
  if (options.field && options.field->range) {
    const auto [low, high] = *options.field->range;
    if (!(std::isfinite(low) && std::isfinite(high) && low < high)) {
      throw InputError(fmt::format("found the range {:g}, {:g}; expected finite ends, the lower one first", low, high));
    }
  }
}

void draw_picture(const std::vector<PictureInput>& files, const PictureOptions& options,
                  const std::filesystem::path& output) {
  check_options(options, output);
  std::vector<Input> inputs = read_inputs(files);
  if (options.field) find_fields(inputs, *options.field);
  // The drawing's diagonal is at most that of the picture.
  const double pixel = size_of(inputs) / std::hypot(options.width, options.height);
  std::vector<Drawable> drawables;
  for (const Input& input : inputs) {
    drawables.push_back(labelled(input.label, [&] { return make_drawable(input.data, input.field, 0.2 * pixel); }));
  }
  Sheet sheet{.drawables = drawables};
  if (options.field) sheet.range = options.field->range.value_or(value_range(drawables, *options.field));
  write_file(output, draw_sheet(sheet, options));
}

bool has_field(const std::filesystem::path& file, const std::string& name) {
  return has_field(read_data_file(file), name);
}

}  // namespace isorim::io::picture
