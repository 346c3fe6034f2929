#include "io/drawing/pdf_writer.h"

#include <cctype>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "io/drawing/annotations.h"
#include "io/drawing/text_metrics.h"
#include "tests/io/cli/program_test.h"
#include "tests/io/drawing/samples.h"

namespace isorim::io::drawing {
namespace {

using geometry::NurbsCurve;
using geometry::Point2;
using geometry::Points;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double points_per_mm = 72.0 / 25.4;

Sheet curves_sheet() {
  return {"Curves", curves_drawing(), {{-5.0, -10.0}, {205.0, 150.0}}};
}

/// The paths that a content stream strokes, in the drawing's coordinates.
std::vector<NurbsCurve<2>> stroked_curves(const std::string& pdf, const Point2& origin) {
  std::istringstream stream(pdf);
  std::vector<NurbsCurve<2>> result;
  std::vector<NurbsCurve<2>> path;
  std::vector<double> operands;
  Point2 at = Point2::Zero();
  for (std::string token; stream >> token;) {
    std::istringstream number(token);
    double value = 0.0;
    if (number >> value && number.eof()) {
      operands.push_back(value);
      continue;
    }
    if (token == "m" || token == "l" || token == "c") {
      const auto count = static_cast<Eigen::Index>(operands.size() / 2);
      Points<2> points(2, count + 1);
      points.col(0) = at;
      for (Eigen::Index i = 0; i < count; ++i)
        points.col(i + 1) =
            origin + Point2(operands[2 * static_cast<std::size_t>(i)], operands[2 * static_cast<std::size_t>(i) + 1]);
      at = points.col(count);
      if (token != "m")
        path.push_back(NurbsCurve<2>::from_points(geometry::KnotVector::bezier(static_cast<int>(count)), points));
    } else if (token == "S") {
      result.push_back(geometry::join<2>(path, 1e-9));
      path.clear();
    }
    operands.clear();
  }
  return result;
}

TEST(Pdf, CurvesAreWithinAThousandthOfAMillimetre) {
  const Sheet sheet = curves_sheet();
  const auto drawn = stroked_curves(to_pdf({&sheet, 1}), sheet.page.lower);
  const auto curves = sample_curves();
  ASSERT_EQ(drawn.size(), curves.size());
  for (std::size_t i = 0; i < curves.size(); ++i) EXPECT_LT(distance(drawn[i], curves[i]), 0.001) << i;
}

TEST(Pdf, CrossReferencesPointAtTheirObjects) {
  const Sheet sheet = curves_sheet();
  const std::string pdf = to_pdf({&sheet, 1}, {"", Tiling{}});
  const std::size_t start = std::stoul(pdf.substr(pdf.rfind("startxref") + 10));
  ASSERT_EQ(pdf.substr(start, 4), "xref");
  std::istringstream table(pdf.substr(start + 5));
  int first = 0;
  int count = 0;
  std::string line;
  table >> first >> count;
  std::getline(table, line);
  std::getline(table, line);
  ASSERT_EQ(line, "0000000000 65535 f ");
  for (int object = 1; object < count; ++object) {
    std::getline(table, line);
    ASSERT_EQ(line.size(), 19U);
    EXPECT_EQ(pdf.substr(std::stoul(line), fmt::format("{} 0 obj\n", object).size()),
              fmt::format("{} 0 obj\n", object));
  }
}

TEST(Pdf, IsTheSameEveryTime) {
  const Sheet sheet = curves_sheet();
  EXPECT_EQ(to_pdf({&sheet, 1}, {"", Tiling{}}), to_pdf({&sheet, 1}, {"", Tiling{}}));
}

TEST(Pdf, RefusesWhatNoReaderShows) {
  EXPECT_THROW(to_pdf({}), InputError);
  Sheet sheet = curves_sheet();
  sheet.page.upper.x() = 5100.0;
  EXPECT_THAT(
      [&] {
        static_cast<void>(to_pdf({&sheet, 1}));
      },
      ThrowsMessage<InputError>(HasSubstr("at most 5080 mm: tile it")));
  EXPECT_FALSE(to_pdf({&sheet, 1}, {"", Tiling{}}).empty());
}

/// What poppler, which has nothing to do with the writer, finds in the files.
class PdfFile : public ::isorim::testing::ProgramTest {
 protected:
  void SetUp() override {
    if (!has_program("pdfinfo") || !has_program("pdftotext") || !has_program("pdftoppm"))
      GTEST_SKIP() << "poppler-utils is not installed";
  }
  std::filesystem::path write_sheet(const Sheet& sheet, const PdfOptions& options = {}) const {
    write_pdf(folder() / "sheet.pdf", {&sheet, 1}, options);
    return folder() / "sheet.pdf";
  }
};

TEST_F(PdfFile, PagesAreInTrueSize) {
  const auto path = write_sheet({"Größe 1:1 ∇", curves_drawing(), {{0.0, 0.0}, {1189.0, 841.0}}});
  const std::string about = output_of(fmt::format("pdfinfo '{}'", path.string()));
  EXPECT_THAT(about, HasSubstr("Größe 1:1 ∇"));
  EXPECT_THAT(about, HasSubstr("Pages:           1\n"));
  EXPECT_THAT(about, HasSubstr("3370.39 x 2383.94 pts (A0)"));
}

/// The box of a word, in mm from the upper left corner.
Rectangle word_box(const std::string& boxes, const std::string& word) {
  const std::size_t end = boxes.find(">" + word + "<");
  const std::size_t start = boxes.rfind("<word", end);
  std::array<double, 4> values{};
  std::size_t at = start;
  for (double& value : values) {
    at = boxes.find("=\"", at) + 2;
    value = std::stod(boxes.substr(at)) / points_per_mm;
  }
  return {{values[0], values[1]}, {values[2], values[3]}};
}

TEST_F(PdfFile, TextsStandWhereTheyShould) {
  Drawing drawing;
  drawing.add_layer({"text"});
  drawing.add(0, Text{"left", {50.0, 80.0}, 5.0});
  drawing.add(0, Text{"centred", {50.0, 60.0}, 5.0, Horizontal::centre, Vertical::middle});
  drawing.add(0, Text{"right", {50.0, 40.0}, 5.0, Horizontal::right, Vertical::top});
  const auto path = write_sheet({"", drawing, {{0.0, 0.0}, {100.0, 100.0}}});
  const std::string boxes = output_of(fmt::format("pdftotext -bbox '{}' -", path.string()));
  const Rectangle left = word_box(boxes, "left");
  EXPECT_NEAR(left.lower.x(), 50.0, 1e-3);
  EXPECT_NEAR(left.upper.x(), 50.0 + text_width("left", 5.0), 0.02);
  const Rectangle centred = word_box(boxes, "centred");
  EXPECT_NEAR(0.5 * (centred.lower.x() + centred.upper.x()), 50.0, 0.02);
  EXPECT_NEAR(word_box(boxes, "right").upper.x(), 50.0, 0.02);
  // The three baselines are those of letters of one size, so the boxes are as far apart as they are.
  EXPECT_NEAR(centred.lower.y() - left.lower.y(), 20.0 + 2.5, 1e-3);
  EXPECT_NEAR(word_box(boxes, "right").lower.y() - centred.lower.y(), 20.0 + 2.5, 1e-3);
}

TEST_F(PdfFile, ScaleBarsMeasureTrue) {
  Drawing drawing;
  drawing.add_layer({"bar", black, 0.2});
  add_scale_bar(drawing, 0, {20.0, 10.0}, 100.0, "100 mm");
  const auto images = render(write_sheet({"", drawing, {{0.0, 0.0}, {150.0, 30.0}}}));
  ASSERT_EQ(images.size(), 1U);
  EXPECT_NEAR(images[0].width, 1500, 1);
  EXPECT_NEAR(images[0].height, 300, 1);
  // The bar itself, and ticks every 10 mm 1 mm above it.
  int first = 1500;
  int last = 0;
  for (int x = 0; x < 1500; ++x) {
    if (images[0].at(x, 200) < 128) {
      first = std::min(first, x);
      last = x;
    }
  }
  EXPECT_NEAR(first, 200, 2);
  EXPECT_NEAR(last, 1200, 2);
  for (int x = 150; x < 1250; ++x) {
    const bool is_tick = (x - 200) % 100 == 0;
    if (is_tick) {
      EXPECT_TRUE(images[0].is_dark_near(x, 190, 128)) << x;
    }
    if ((x - 200) % 100 == 50) {
      EXPECT_FALSE(images[0].is_dark_near(x, 190, 200)) << x;
    }
  }
}

TEST_F(PdfFile, CircleIsRoundOnPaper) {
  Drawing drawing;
  drawing.add_layer({"circle", black, 0.2});
  drawing.add(0, Circle{{50.0, 50.0}, 40.0});
  const auto images = render(write_sheet({"", drawing, {{0.0, 0.0}, {100.0, 100.0}}}));
  ASSERT_EQ(images.size(), 1U);
  for (int y = 0; y < images[0].height; ++y) {
    for (int x = 0; x < images[0].width; ++x) {
      if (images[0].at(x, y) < 128) {
        EXPECT_NEAR(std::hypot(x + 0.5 - 500.0, y + 0.5 - 500.0), 400.0, 2.0);
      }
    }
  }
  EXPECT_TRUE(images[0].is_dark_near(100, 500, 64));
  EXPECT_TRUE(images[0].is_dark_near(500, 900, 64));
}

}  // namespace
}  // namespace isorim::io::drawing
