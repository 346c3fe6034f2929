#pragma once

#include <string>
#include <vector>

#include "io/results/json.h"
#include "io/results/report.h"

/// Text for the terminal.
namespace isorim::io {

enum class Align { left, right };

/// Columns as wide as their widest cell, two spaces between them. A row may be shorter than the heading.
class TextTable {
 public:
  struct Column {
    std::string heading;
    Align align = Align::left;
  };
  explicit TextTable(std::vector<Column> columns);
  void add_row(std::vector<std::string> cells);
  /// Every line begun with `indent` spaces and ended with '\n'.
  std::string text(int indent = 0) const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// 17 significant digits where they are needed to give the same bits back, else fewer.
std::string exact_number(double x);

/// What the shape is made of: "3D, 1 patch, 8 elements, closed".
std::string geometry_line(const GeometrySummary& geometry);

/// Title, shape, then a line for each number: value, error estimate, expected value, difference, met or missed.
std::string results_text(const Report& report);

/// A line for each expectation of each case, failures in their place, and a line that sums up.
std::string verification_text(const std::vector<VerifiedCase>& cases);

}  // namespace isorim::io
