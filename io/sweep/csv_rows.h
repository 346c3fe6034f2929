#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace isorim::io {

/// A file of text in rows and columns.
struct CsvRows {
  /// As messages call it.
  std::shared_ptr<const std::string> name;
  std::vector<std::string> headings;
  /// Each as long as `headings`.
  std::vector<std::vector<std::string>> rows;
  /// Of each row, where it begins; from 1.
  std::vector<int> lines;
};

/// Reads comma-separated values (RFC 4180): a line of headings, then rows. If the headings have a semicolon, or else a
/// tab, outside quotes, that separates the fields instead. Blanks round a field, empty lines and lines that begin with
/// # are passed over; a byte order mark and both kinds of line ends are taken.
///
/// Throws InputError "name:line: ..." for a quote that is not closed, text behind a closing quote, a row of another
/// number of fields, a heading that is empty or there twice, and a file without rows.
CsvRows parse_csv(std::string_view text, const std::string& name);

/// A field as parse_csv() takes it back: in quotes if it has to be.
std::string csv_field(std::string_view text);

}  // namespace isorim::io
