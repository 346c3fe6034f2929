#include <exception>
#include <optional>
#include <ostream>
#include <string>

#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"
#include "io/cli/commands.h"
#include "io/results/inspection.h"
#include "io/results/pictures.h"

namespace isorim::cli {
namespace {

/// The boundary; of a CAD file that makes none the reason, so that the rest can be told all the same.
std::optional<io::AnyModel> model_of(const io::CaseFile& file, std::string& failure) {
  try {
    return io::build_model(file);
  } catch (const Error& error) {
    if (!file.cad) throw;
    failure = error.what();
    return std::nullopt;
  }
}

io::Inspection inspection_of(const io::CaseFile& file, const CheckArguments& arguments) {
  io::Inspection inspection;
  std::string failure;
  const std::optional<io::AnyModel> model = model_of(file, failure);
  if (!model) {
    inspection.title = file.title();
    inspection.cad = file.cad;
    inspection.failure = failure;
    return inspection;
  }
  inspection = io::inspect(file, *model, {.threads = arguments.threads, .progress = {}});
  const std::filesystem::path folder = arguments.output.value_or(std::filesystem::path("out") / file.name());
  if (io::has_free_edges(*model)) {
    io::make_folder(folder);
    io::write_free_edges_vtu(folder / "free_edges.vtu", *model);
    inspection.free_edges_file = (folder / "free_edges.vtu").string();
  }
  return inspection;
}

}  // namespace

int check_case(const CheckArguments& arguments, std::ostream& out, std::ostream& err) {
  const io::CaseFile file =
      io::read_case_or_cad(arguments.case_file, arguments.overrides,
                           {.refused_faces = io::RefusedFaces::leave_out, .threads = arguments.threads});
  const io::Inspection inspection = inspection_of(file, arguments);
  out << (arguments.format == OutputFormat::json ? io::inspection_json(inspection) : io::inspection_text(inspection));
  if (!inspection.failure.empty()) print_message(err, inspection.failure);
  const std::size_t refused = file.cad ? file.cad->refused.size() : 0;
  if (refused > 0) {
    print_message(
        err, fmt::format("{}: {} of {} faces cannot be taken", arguments.case_file.string(), refused, file.cad->faces));
  }
  return inspection.failure.empty() && refused == 0 ? 0 : 2;
}

}  // namespace isorim::cli
