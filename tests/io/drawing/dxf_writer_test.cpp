#include "io/drawing/dxf_writer.h"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "io/drawing/annotations.h"
#include "tests/io/cli/program_test.h"
#include "tests/io/drawing/samples.h"

namespace isorim::io::drawing {
namespace {

using geometry::NurbsCurve;
using geometry::Point2;
using geometry::Points;

struct Group {
  int code = 0;
  std::string value;
};

/// An object: its type (the group 0) and the groups up to the next one.
struct Record {
  std::string type;
  std::vector<Group> groups;

  std::vector<double> numbers(int code) const {
    std::vector<double> result;
    for (const Group& group : groups)
      if (group.code == code) result.push_back(std::stod(group.value));
    return result;
  }
  std::string text(int code) const {
    const auto found = std::ranges::find(groups, code, &Group::code);
    return found == groups.end() ? "" : found->value;
  }
};

std::vector<Record> records_of(const std::string& dxf) {
  std::istringstream stream(dxf);
  std::vector<Record> records;
  std::string code;
  for (std::string value; std::getline(stream, code) && std::getline(stream, value);) {
    if (std::stoi(code) == 0) {
      records.push_back({value, {}});
    } else {
      records.back().groups.push_back({std::stoi(code), value});
    }
  }
  return records;
}

std::vector<Record> of_type(const std::vector<Record>& records, const std::string& type) {
  std::vector<Record> result;
  std::ranges::copy_if(records, std::back_inserter(result), [&](const Record& record) { return record.type == type; });
  return result;
}

NurbsCurve<2> spline_of(const Record& record) {
  const auto x = record.numbers(10);
  const auto y = record.numbers(20);
  Points<2> points(2, static_cast<Eigen::Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) points.col(static_cast<Eigen::Index>(i)) << x[i], y[i];
  return NurbsCurve<2>::from_points(geometry::KnotVector(std::stoi(record.text(71)), record.numbers(40)), points,
                                    record.numbers(41));
}

TEST(Dxf, SplinesAreTheCurvesThemselves) {
  const auto records = records_of(to_dxf(curves_drawing()));
  const auto splines = of_type(records, "SPLINE");
  const auto curves = sample_curves();
  // The straight line is a polyline.
  ASSERT_EQ(splines.size(), curves.size() - 1);
  ASSERT_EQ(of_type(records, "LWPOLYLINE").size(), 1U);
  for (std::size_t i = 1; i < curves.size(); ++i) {
    const Record& record = splines[i - 1];
    const NurbsCurve<2> curve = spline_of(record);
    EXPECT_EQ(std::stoul(record.text(72)), record.numbers(40).size());
    EXPECT_EQ(std::stoul(record.text(73)), record.numbers(10).size());
    EXPECT_EQ(std::stoi(record.text(70)), curves[i].is_polynomial() ? 8 : 12);
    if (curves[i].degree() <= 10) {
      EXPECT_EQ(curve.knots(), curves[i].knots());
      EXPECT_LT((curve.homogeneous() - curves[i].homogeneous()).cwiseAbs().maxCoeff(), 1e-13) << i;
    } else {
      EXPECT_EQ(curve.degree(), 3);
      EXPECT_LT(distance(curve, curves[i]), 0.001);
    }
  }
}

TEST(Dxf, HandlesAreUniqueAndOwnersExist) {
  Drawing drawing = curves_drawing();
  add_scale_bar(drawing, 0, {0.0, 0.0}, 100.0, "100 mm");
  add_dimension(drawing, 0, {0.0, 0.0}, {50.0, 0.0}, 10.0, "50");
  std::set<std::string> handles;
  const auto records = records_of(to_dxf(drawing));
  for (const Record& record : records) {
    if (record.type == "SECTION") continue;
    const std::string handle = record.type == "DIMSTYLE" ? record.text(105) : record.text(5);
    if (!handle.empty()) {
      EXPECT_TRUE(handles.insert(handle).second) << record.type << ' ' << handle;
    }
  }
  for (const Record& record : records) {
    for (const int code : {330, 340, 350, 390}) {
      const std::string owner = record.text(code);
      if (!owner.empty() && owner != "0") {
        EXPECT_TRUE(handles.contains(owner)) << record.type << ' ' << owner;
      }
    }
  }
}

TEST(Dxf, LengthsAreMillimetres) {
  const std::string dxf = to_dxf(curves_drawing());
  EXPECT_NE(dxf.find("  9\n$INSUNITS\n 70\n4\n"), std::string::npos);
  EXPECT_NE(dxf.find("  9\n$ACADVER\n  1\nAC1015\n"), std::string::npos);
  EXPECT_NE(dxf.find("  9\n$MEASUREMENT\n 70\n1\n"), std::string::npos);
}

TEST(Dxf, ScalesEverything) {
  Drawing drawing;
  drawing.add_layer({"0", black, 0.5, LineType::dashed});
  drawing.add(0, Circle{{1.0, 2.0}, 3.0});
  drawing.add(0, Text{"text", {4.0, 5.0}, 2.5});
  const auto records = records_of(to_dxf(drawing, {.scale = 50.0}));
  const Record circle = of_type(records, "CIRCLE").at(0);
  EXPECT_EQ(circle.numbers(10).at(0), 50.0);
  EXPECT_EQ(circle.numbers(20).at(0), 100.0);
  EXPECT_EQ(circle.numbers(40).at(0), 150.0);
  // Dashes of a line twice as wide as that of the table.
  EXPECT_EQ(circle.numbers(48).at(0), 2.0);
  EXPECT_EQ(of_type(records, "TEXT").at(0).numbers(40).at(0), 125.0);
  EXPECT_THROW(static_cast<void>(to_dxf(drawing, {.scale = 0.0})), InputError);
}

TEST(Dxf, LayersKeepNamesLinesAndColours) {
  Drawing drawing;
  drawing.add_layer({"CORTE50_5", {255, 0, 0}, 0.34, LineType::continuous});
  drawing.add_layer({"Achse ä∇", black, 0.7, LineType::chain});
  const auto layers = of_type(records_of(to_dxf(drawing)), "LAYER");
  ASSERT_EQ(layers.size(), 3U);
  EXPECT_EQ(layers[1].text(2), "CORTE50_5");
  EXPECT_EQ(layers[1].text(62), "1");
  EXPECT_EQ(layers[1].text(370), "35");
  EXPECT_EQ(layers[2].text(2), "Achse \xE4\\U+2207");
  EXPECT_EQ(layers[2].text(62), "7");
  EXPECT_EQ(layers[2].text(6), "CHAIN");
}

TEST(Dxf, CurvesThatJumpAreTwo) {
  const geometry::KnotVector knots(2, {0, 0, 0, 1, 1, 1, 2, 2, 2});
  Points<2> points(2, 6);
  points << 0, 1, 2, 5, 6, 7, 0, 3, 0, 0, -3, 0;
  Drawing drawing;
  drawing.add_layer({"0"});
  drawing.add(0, Path{{NurbsCurve<2>::from_points(knots, points)}});
  const auto splines = of_type(records_of(to_dxf(drawing)), "SPLINE");
  ASSERT_EQ(splines.size(), 2U);
  EXPECT_EQ(splines[1].numbers(10), (std::vector<double>{5, 6, 7}));
}

TEST(Dxf, ColoursAreTheNearestOfTheTable) {
  EXPECT_EQ(colour_index({0, 0, 0}), 7);
  EXPECT_EQ(colour_index({255, 0, 0}), 1);
  EXPECT_EQ(colour_index({0, 255, 0}), 3);
  EXPECT_EQ(colour_index({0, 0, 255}), 5);
  EXPECT_EQ(colour_index({255, 127, 0}), 30);
  EXPECT_EQ(colour_index({192, 192, 192}), 9);
  EXPECT_EQ(colour_index({127, 0, 0}), 14);
}

/// What ezdxf, which has nothing to do with the writer, reads.
class DxfFile : public ::isorim::testing::ProgramTest {};

TEST_F(DxfFile, IsReadByEzdxfWithoutComplaint) {
  if (output_of("/usr/bin/python3 -c 'import ezdxf; print(1)'") != "1\n") GTEST_SKIP() << "python3-ezdxf is missing";
  Drawing drawing = curves_drawing();
  const std::size_t notes = drawing.add_layer({"notes ä", blue, 0.18, LineType::dashed});
  add_dimension(drawing, notes, {0.0, 0.0}, {50.0, 0.0}, 10.0, "50 ± 1");
  drawing.add(notes, Text{"centre", {30.0, 40.0}, 5.0, Horizontal::centre, Vertical::middle, 30.0});
  drawing.add(notes,
              Fill{{{geometry::circle_curve(20.0, {60.0, 70.0})}, {geometry::circle_curve(10.0, {60.0, 70.0})}}});
  write_dxf(folder() / "sheet.dxf", drawing);
  write("read.py", R"(import sys, ezdxf
doc = ezdxf.readfile(sys.argv[1])
audit = doc.audit()
print(len(audit.errors), len(audit.fixes), doc.dxfversion, doc.units)
print(*[layer.dxf.name for layer in doc.layers if layer.dxf.name != 'Defpoints'], sep='|')
for e in doc.modelspace():
    if e.dxftype() == 'SPLINE':
        c = e.construction_tool()
        print('spline', c.degree, *['%.12f %.12f' % (p.x, p.y) for p in (c.point(k * c.max_t / 8) for k in range(9))])
    if e.dxftype() == 'TEXT':
        print('text', e.plain_text())
    if e.dxftype() == 'HATCH':
        print('hatch', len(e.paths), e.dxf.solid_fill)
)");
  const std::string read = output_of(fmt::format("/usr/bin/python3 '{}' '{}'", path("read.py"), path("sheet.dxf")));
  std::istringstream lines(read);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "0 0 AC1015 4");
  std::getline(lines, line);
  EXPECT_EQ(line, "0|curves|notes ä");
  const auto curves = sample_curves();
  for (std::size_t i = 1; i < curves.size(); ++i) {
    std::string kind;
    int degree = 0;
    lines >> kind >> degree;
    ASSERT_EQ(kind, "spline");
    for (int k = 0; k <= 8; ++k) {
      Point2 point;
      lines >> point.x() >> point.y();
      if (curves[i].degree() <= 10) {
        EXPECT_LT((point - evaluate(curves[i], k / 8.0)).norm(), 1e-9) << i;
      }
    }
  }
  EXPECT_NE(read.find("text 50 ± 1"), std::string::npos) << read;
  EXPECT_NE(read.find("hatch 2 1"), std::string::npos) << read;
}

}  // namespace
}  // namespace isorim::io::drawing
