// Runs a case and writes its results, by the installed libraries: case_results CASE.toml

#include <cstdio>

#include "geometry/errors.h"
#include "io/case/case_file.h"
#include "io/results/compute.h"
#include "io/results/hdf5.h"
#include "io/results/json.h"
#include "io/results/pictures.h"

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return 2;
  try {
    const isorim::io::CaseFile file = isorim::io::read_case(arguments[1]);
    const isorim::io::AnyModel model = isorim::io::build_model(file);
    const isorim::io::Report report = isorim::io::compute(file, model);
    isorim::io::write_boundary_vtu("boundary.vtu", model);
    isorim::io::write_hdf5("results.h5", report, model);
    isorim::io::write_json("results.json", report);
    return isorim::io::exit_status(report.status);
  } catch (const isorim::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
