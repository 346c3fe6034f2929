#include "geometry/intersection/loop_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace isorim::geometry {
namespace {

/// A place on a loop.
struct LoopPosition {
  int piece = 0;
  double s = 0.0;
};

/// Which way a walk along a loop goes.
enum class Way { forward, backward };

/// The first point of a walk from `from` outside the disc; `met_other` tells whether `other` (may be null) was passed
/// before.
struct DiscExit {
  Point2 place;
  bool left_disc = false;
  bool met_other = false;
};

class DiscWalk {
 public:
  DiscWalk(const PlaneLoop& loop, const Point2& centre, double radius)
      : loop_(loop), centre_(centre), radius_(radius) {}

  DiscExit walk(const LoopPosition& from, Way way, const LoopPosition* other) const {
    const int count = static_cast<int>(loop_.pieces.size());
    const double end = way == Way::forward ? 1.0 : 0.0;
    DiscExit result;
    LoopPosition at = from;
    for (int step = 0; step <= count; ++step) {
      const std::optional<double> out = exit_parameter(at, end);
      const bool same_piece = other && other->piece == at.piece;
      if (same_piece && between(at.s, other->s, out.value_or(end)) && !(step == 0 && other->s == at.s)) {
        result.met_other = true;
        return result;
      }
      if (out) {
        result.place = evaluate(piece(at.piece), *out);
        result.left_disc = true;
        return result;
      }
      at.piece = (at.piece + (way == Way::forward ? 1 : count - 1)) % count;
      at.s = 1.0 - end;
    }
    return result;
  }

 private:
  const PlanePiece& piece(int index) const { return loop_.pieces[static_cast<std::size_t>(index)]; }
  static bool between(double a, double x, double b) { return std::min(a, b) <= x && x <= std::max(a, b); }
  bool outside(const PlanePiece& part, double s) const { return (evaluate(part, s) - centre_).norm() > radius_; }

  /// Where the piece first leaves the disc between at.s and end.
  std::optional<double> exit_parameter(const LoopPosition& at, double end) const {
    constexpr int samples = 16;
    const PlanePiece& part = piece(at.piece);
    double inside = at.s;
    for (int i = 1; i <= samples; ++i) {
      double next = at.s + (end - at.s) * i / samples;
      if (!outside(part, next)) {
        inside = next;
        continue;
      }
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (inside + next);
        (outside(part, middle) ? next : inside) = middle;
      }
      return next;
    }
    return std::nullopt;
  }

  const PlaneLoop& loop_;
  Point2 centre_;
  double radius_;
};

/// A place where two pieces come nearer than the tolerance.
struct Contact {
  int first_loop = 0;
  int second_loop = 0;
  LoopPosition first;
  LoopPosition second;
  Point2 place = Point2::Zero();
};

class ContactJudge {
 public:
  ContactJudge(const std::vector<PlaneLoop>& loops, double tolerance) : loops_(loops), tolerance_(tolerance) {}

  /// What happens at a contact; nothing if the strands only touch. `radius` becomes that of the disc that decided.
  std::optional<ContactKind> judge(const Contact& contact, double& radius) const {
    const double size = std::min(loop(contact.first_loop).diagonal(), loop(contact.second_loop).diagonal());
    const double largest = 0.1 * size;
    for (radius = std::min(8.0 * tolerance_, largest);; radius = std::min(4.0 * radius, largest)) {
      const Strands strands = leave_disc(contact, radius);
      if (strands.joined) return std::nullopt;
      if (strands.separation > tolerance_) {
        return alternate(strands, contact.place) ? std::optional(ContactKind::crossing) : std::nullopt;
      }
      const bool coincide = radius >= 4e-3 * size && strands.separation <= 1e-4 * tolerance_;
      if (coincide || radius >= largest) return ContactKind::overlap;
    }
  }

 private:
  struct Strands {
    /// Where the first strand enters and leaves the disc, then the second one.
    std::array<Point2, 4> ends;
    /// The strands are one within the disc (a joint or a cusp of one loop).
    bool joined = false;
    /// Least distance of an end of the first strand from one of the second.
    double separation = 0.0;
  };

  const PlaneLoop& loop(int index) const { return loops_[static_cast<std::size_t>(index)]; }

  Strands leave_disc(const Contact& contact, double radius) const {
    Strands strands;
    const bool same_loop = contact.first_loop == contact.second_loop;
    std::size_t next = 0;
    for (const bool of_first : {true, false}) {
      const DiscWalk disc(loop(of_first ? contact.first_loop : contact.second_loop), contact.place, radius);
      const LoopPosition& from = of_first ? contact.first : contact.second;
      const LoopPosition* other = same_loop ? (of_first ? &contact.second : &contact.first) : nullptr;
      for (const Way way : {Way::backward, Way::forward}) {
        const DiscExit exit = disc.walk(from, way, other);
        strands.joined = strands.joined || exit.met_other || !exit.left_disc;
        strands.ends[next++] = exit.place;
      }
    }
    if (strands.joined) return strands;
    strands.separation = (strands.ends[0] - strands.ends[2]).norm();
    for (const auto& [i, j] : {std::pair{0, 3}, std::pair{1, 2}, std::pair{1, 3}}) {
      strands.separation =
          std::min(strands.separation,
                   (strands.ends[static_cast<std::size_t>(i)] - strands.ends[static_cast<std::size_t>(j)]).norm());
    }
    return strands;
  }

  /// Does exactly one end of the second strand lie on the arc from one end of the first to the other?
  static bool alternate(const Strands& strands, const Point2& centre) {
    const auto angle_after_first = [&](std::size_t i) {
      const Vector2 reference = strands.ends[0] - centre;
      const Vector2 ray = strands.ends[i] - centre;
      const double angle = std::atan2(reference.x() * ray.y() - reference.y() * ray.x(), reference.dot(ray));
      return angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
    };
    const double end = angle_after_first(1);
    return (angle_after_first(2) < end) != (angle_after_first(3) < end);
  }

  const std::vector<PlaneLoop>& loops_;
  double tolerance_;
};

/// The place where the pieces meet near (s, t), by Newton's method; `nearby` if that leads away (parallel strands).
Point2 meeting_point(const PlanePiece& a, double s, const PlanePiece& b, double t, const Point2& nearby, double reach) {
  constexpr double step = 1e-6;
  for (int i = 0; i < 8; ++i) {
    const Vector2 apart = evaluate(b, t) - evaluate(a, s);
    const Vector2 da = (evaluate(a, s + step) - evaluate(a, s - step)) / (2.0 * step);
    const Vector2 db = (evaluate(b, t + step) - evaluate(b, t - step)) / (2.0 * step);
    const double determinant = da.x() * db.y() - da.y() * db.x();
    if (std::abs(determinant) <= 1e-9 * da.norm() * db.norm()) return nearby;
    s += (apart.x() * db.y() - apart.y() * db.x()) / determinant;
    t += (apart.x() * da.y() - apart.y() * da.x()) / determinant;
    if (std::abs(s - 0.5) > 0.6 || std::abs(t - 0.5) > 0.6) return nearby;
  }
  const Point2 place = evaluate(a, s);
  return (place - nearby).norm() <= reach && (place - evaluate(b, t)).norm() <= 1e-3 * reach ? place : nearby;
}

/// Bisects one pair of pieces down to its contacts and judges each.
class PairSearch {
 public:
  PairSearch(const ContactJudge& judge, double tolerance) : judge_(judge), tolerance_(tolerance) {}

  std::optional<LoopConflict> search(const Contact& pair, const PlanePiece& a, const PlanePiece& b) {
    pair_ = pair;
    first_ = &a;
    second_ = &b;
    done_.clear();
    return descend(a, {0.0, 1.0}, b, {0.0, 1.0});
  }

 private:
  struct Disc {
    Point2 centre;
    double radius;
  };

  std::optional<LoopConflict> descend(const PlanePiece& a, Interval range_a, const PlanePiece& b, Interval range_b) {
    const double smallest = 0.25 * tolerance_;
    if (are_separated(a, b, smallest) || is_done(a, b)) return std::nullopt;
    const bool a_small = a.diagonal() <= smallest;
    const bool b_small = b.diagonal() <= smallest;
    if (a_small && b_small) return judge_leaf(a, range_a.middle(), range_b.middle());
    if (b_small || (!a_small && a.diagonal() >= b.diagonal())) {
      const auto [left, right] = bisect(a);
      std::optional<LoopConflict> found = descend(left, {range_a.first, range_a.middle()}, b, range_b);
      return found ? found : descend(right, {range_a.middle(), range_a.last}, b, range_b);
    }
    const auto [left, right] = bisect(b);
    std::optional<LoopConflict> found = descend(a, range_a, left, {range_b.first, range_b.middle()});
    return found ? found : descend(a, range_a, right, {range_b.middle(), range_b.last});
  }

  /// Both lie in a disc in which a contact of this pair was found harmless.
  bool is_done(const PlanePiece& a, const PlanePiece& b) const {
    return std::ranges::any_of(done_, [&](const Disc& disc) {
      const auto inside = [&](const PlanePiece& part) {
        return (part.lower - disc.centre).cwiseAbs().cwiseMax((part.upper - disc.centre).cwiseAbs()).norm() <
               disc.radius;
      };
      return inside(a) && inside(b);
    });
  }

  std::optional<LoopConflict> judge_leaf(const PlanePiece& a, double s, double t) {
    Contact contact = pair_;
    contact.first.s = s;
    contact.second.s = t;
    contact.place = 0.5 * (a.lower + a.upper);
    double radius = 0.0;
    const std::optional<ContactKind> kind = judge_.judge(contact, radius);
    if (!kind) {
      done_.push_back({contact.place, radius});
      return std::nullopt;
    }
    if (*kind == ContactKind::crossing) {
      contact.place = meeting_point(*first_, s, *second_, t, contact.place, radius);
    }
    return LoopConflict{
        *kind, contact.first_loop, contact.second_loop, contact.first.piece, contact.second.piece, contact.place};
  }

  const ContactJudge& judge_;
  double tolerance_;
  Contact pair_;
  const PlanePiece* first_ = nullptr;
  const PlanePiece* second_ = nullptr;
  std::vector<Disc> done_;
};

struct SweepItem {
  int loop = 0;
  int piece = 0;
  const PlanePiece* shape = nullptr;
};

}  // namespace

PlaneLoop::PlaneLoop(std::vector<PlanePiece> parts) : pieces(std::move(parts)) {
  lower = pieces.front().lower;
  upper = pieces.front().upper;
  for (const PlanePiece& piece : pieces) {
    lower = lower.cwiseMin(piece.lower);
    upper = upper.cwiseMax(piece.upper);
  }
}

std::optional<LoopConflict> find_loop_conflict(const std::vector<PlaneLoop>& loops, double tolerance) {
  std::vector<SweepItem> items;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    for (std::size_t k = 0; k < loops[i].pieces.size(); ++k) {
      items.push_back({static_cast<int>(i), static_cast<int>(k), &loops[i].pieces[k]});
    }
  }
  std::ranges::sort(items, {}, [](const SweepItem& item) { return item.shape->lower.x(); });

  const ContactJudge judge(loops, tolerance);
  PairSearch pair_search(judge, tolerance);
  std::vector<const SweepItem*> active;
  for (const SweepItem& item : items) {
    std::erase_if(active,
                  [&](const SweepItem* old) { return old->shape->upper.x() + tolerance < item.shape->lower.x(); });
    for (const SweepItem* old : active) {
      if (are_separated(*old->shape, *item.shape, tolerance)) continue;
      const Contact pair{old->loop, item.loop, {old->piece, 0.0}, {item.piece, 0.0}};
      if (std::optional<LoopConflict> found = pair_search.search(pair, *old->shape, *item.shape)) return found;
    }
    active.push_back(&item);
  }
  return std::nullopt;
}

}  // namespace isorim::geometry
