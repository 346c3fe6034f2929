#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// The words of a text file, with the line of each.
namespace isorim::io::tspline {

class Words {
 public:
  /// The text has to outlive it. What follows `comment` on a line is left out; 0: there are no comments.
  explicit Words(std::string_view text, char comment = 0);

  /// No word is left.
  bool at_end() const { return word_.empty(); }
  /// The next word; empty at the end.
  std::string_view peek() const { return word_; }
  /// Of the next word, counted from 1; of the last one at the end.
  int line() const { return line_; }
  /// Bytes from the next word to the end: an upper bound of twice the number of words that are left.
  std::size_t remaining() const { return text_.size() - start_; }

  /// The next word, whatever it is. These throw InputError, which names the line, what was found and `what` was
  /// expected: at the end of the file, for a word that is none of the kind, a number that is not finite, an integer
  /// beyond the limits.
  std::string_view word(std::string_view what);
  long integer(std::string_view what, long low, long high);
  double real(std::string_view what);
  /// A number of things that need `words_each` words each: no larger than the rest of the file has room for, so that
  /// memory may be set aside for it.
  std::size_t count(std::string_view what, std::size_t words_each);
  /// Leaves out everything up to the end of the line of the word that was read last.
  void skip_line();

  /// Throws InputError: "line 12: " and the reason.
  [[noreturn]] void refuse(int line, const std::string& reason) const;

 private:
  void advance();
  [[noreturn]] void refuse_word(std::string_view what) const;

  std::string_view text_;
  char comment_;
  std::size_t start_ = 0;
  std::size_t end_ = 0;
  std::string_view word_;
  int line_ = 1;
  int last_line_ = 1;
};

}  // namespace isorim::io::tspline
