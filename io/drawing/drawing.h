#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geometry/nurbs/curve.h"
#include "geometry/vocabulary.h"
#include "io/svg/bezier_path.h"

/// Workshop drawings: what is on the paper, in millimetres, x to the right and y upwards.
namespace isorim::io::drawing {

struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  friend bool operator==(const Colour&, const Colour&) = default;
};

inline constexpr Colour black{0, 0, 0};
inline constexpr Colour grey{150, 150, 150};
inline constexpr Colour red{200, 0, 0};
inline constexpr Colour blue{0, 70, 160};
inline constexpr Colour green{0, 120, 60};

/// Dashes as in ISO 128-2: as long as the line's width tells.
enum class LineType { continuous, dashed, chain, dotted };

/// Lengths in units of the line's width: dash, gap, dash, gap, ...; empty for a continuous line.
std::span<const double> dash_pattern(LineType type);

/// What is drawn in one manner and can be switched off as a whole.
struct Layer {
  std::string name;
  Colour colour = black;
  /// In mm: ISO 128-2 has 0.13, 0.18, 0.25, 0.35, 0.5, 0.7, 1, 1.4, 2.
  double line_width = 0.25;
  LineType line_type = LineType::continuous;
};

using svg::Chain;

/// A chain of curves, each starting where the one before ends.
struct Path {
  Chain chain;
};

struct Polyline {
  /// 2 x n.
  geometry::Points<2> points;
  bool is_closed = false;
};

struct Circle {
  geometry::Point2 centre = geometry::Point2::Zero();
  double radius = 1.0;
};

/// The area inside closed chains, by the even-odd rule, in a colour of its own.
struct Fill {
  std::vector<Chain> chains;
  Colour colour = grey;
};

enum class Horizontal { left, centre, right };
enum class Vertical { baseline, middle, top };

/// One line of text (UTF-8) in Helvetica or what stands in for it.
struct Text {
  std::string text;
  geometry::Point2 place = geometry::Point2::Zero();
  /// Of capital letters, in mm: ISO 3098 has 1.8, 2.5, 3.5, 5, 7, 10, 14, 20.
  double height = 2.5;
  /// Which point of the text `place` is; the middle and the top are those of capital letters.
  Horizontal horizontal = Horizontal::left;
  Vertical vertical = Vertical::baseline;
  /// In degrees, counter-clockwise about `place`.
  double rotation = 0.0;
};

/// Where the baseline of the text starts.
geometry::Point2 text_origin(const Text& text);

using Entity = std::variant<Path, Polyline, Circle, Fill, Text>;

/// An axis-parallel rectangle; empty if lower > upper.
using Rectangle = svg::Bounds;

/// Entities on named layers, in mm. Layers are drawn in the order in which they were added, on each its entities in
/// theirs.
class Drawing {
 public:
  /// The number of the layer. Throws InputError if the name is empty, longer than 255 bytes, taken (capitals count as
  /// small letters) or holds a character that CAD programs refuse (one of <>/\":;?*|,=` or a control character), or if
  /// the line is not wider than zero.
  std::size_t add_layer(Layer layer);
  /// Throws InputError if there is no such layer, a number is not finite, a radius or height is not positive, a
  /// polyline has fewer than two points, or a path or fill no curves.
  void add(std::size_t layer, Entity entity);
  /// All layers and entities of another drawing, moved by `offset`. Layers of the same name become one.
  void add(const Drawing& other, const geometry::Vector2& offset = geometry::Vector2::Zero());

  const std::vector<Layer>& layers() const { return layers_; }
  /// Of one layer.
  const std::vector<Entity>& entities(std::size_t layer) const { return entities_.at(layer); }
  /// The number of the layer, capitals counting as small letters. Throws InputError if there is none.
  std::size_t layer(std::string_view name) const;

 private:
  std::vector<Layer> layers_;
  std::vector<std::vector<Entity>> entities_;
};

/// The smallest rectangle round what is drawn: of curves themselves, not of their control points; of texts, as wide as
/// Helvetica makes them. Lines are taken as infinitely thin.
Rectangle extent(const Drawing& drawing);
Rectangle extent(const Entity& entity);

/// The entity moved by `offset` after scaling about the origin; texts and radii are scaled too. The factor is positive.
Entity scaled(const Entity& entity, double factor, const geometry::Vector2& offset);

/// A drawing on a piece of paper.
struct Sheet {
  /// For the reader; also what tiles are labelled with.
  std::string title;
  Drawing drawing;
  /// The part of the drawing's plane that the paper shows, in mm: its size is the paper's.
  Rectangle page;

  double width() const { return page.upper.x() - page.lower.x(); }
  double height() const { return page.upper.y() - page.lower.y(); }
};

/// Throws InputError if the page of the sheet is empty or not finite.
void require_page(const Sheet& sheet);

/// The sheet whose page is the drawing's extent with a margin, in mm, round it. Throws InputError if the drawing is
/// empty.
Sheet sheet_round(std::string title, Drawing drawing, double margin = 10.0);

/// Two points as a polyline.
Polyline line(const geometry::Point2& from, const geometry::Point2& to);
/// Counter-clockwise from the lower left corner, closed.
Polyline outline(const Rectangle& rectangle);

}  // namespace isorim::io::drawing
