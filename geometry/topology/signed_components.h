#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace isorim::geometry {

/// Sets of items, each with a sign relative to the others of its set (union-find with parity).
class SignedComponents {
 public:
  explicit SignedComponents(int count)
      : parents_(static_cast<std::size_t>(count)), signs_(parents_.size(), 1), sizes_(parents_.size(), 1) {
    for (int i = 0; i < count; ++i) parents_[static_cast<std::size_t>(i)] = i;
  }

  struct Member {
    int component = 0;
    int sign = 1;
  };
  Member find(int item) const {
    Member member{item, 1};
    while (parents_[static_cast<std::size_t>(member.component)] != member.component) {
      member.sign *= signs_[static_cast<std::size_t>(member.component)];
      member.component = parents_[static_cast<std::size_t>(member.component)];
    }
    return member;
  }

  /// Puts two items into one set, their signs in the given relation (+1 equal, -1 opposite). If they are in one already
  /// nothing changes, whatever their relation there.
  void unite(int a, int b, int relation) {
    Member first = find(a);
    Member second = find(b);
    if (first.component == second.component) return;
    if (size(first) < size(second)) std::swap(first, second);
    size(first) += size(second);
    parents_[static_cast<std::size_t>(second.component)] = first.component;
    signs_[static_cast<std::size_t>(second.component)] = first.sign * second.sign * relation;
  }

 private:
  int& size(const Member& member) { return sizes_[static_cast<std::size_t>(member.component)]; }

  std::vector<int> parents_;
  std::vector<int> signs_;
  std::vector<int> sizes_;
};

}  // namespace isorim::geometry
