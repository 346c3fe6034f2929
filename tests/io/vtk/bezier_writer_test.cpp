#include "io/vtk/bezier_writer.h"

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <vtkBezierCurve.h>
#include <vtkBezierQuadrilateral.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataSetSurfaceFilter.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "geometry/errors.h"
#include "geometry/shapes/curves.h"
#include "geometry/shapes/solids.h"
#include "tests/geometry/tspline/extracted_surfaces.h"

namespace isorim::io {
namespace {

using geometry::Boundary;
using geometry::ElementTable;
using geometry::HomogeneousPoints;
using geometry::KnotVector;
using geometry::NurbsCurve;
using geometry::NurbsSurface;
using geometry::Point2;
using geometry::Point3;
using geometry::Vector3;

// ---- Shapes

constexpr double radius = 2.5;
constexpr double major_radius = 3.0;
constexpr double minor_radius = 1.25;

/// The boundary with every patch's parametrisation turned round in v, the orientations as given: outward normals if -1.
Boundary<3> reversed(Boundary<3> boundary, int orientation) {
  for (auto& patch : boundary.patches) {
    patch.shape = reverse(geometry::surface_of(patch.shape), geometry::Direction::v);
    patch.orientation = orientation;
  }
  return boundary;
}

double distance_to_sphere(const Point3& x) {
  return std::abs(x.norm() - radius);
}
double distance_to_torus(const Point3& x) {
  return std::abs(std::hypot(std::hypot(x.x(), x.y()) - major_radius, x.z()) - minor_radius);
}

enum class Weights { one, random };

double random_weight(Weights weights, std::mt19937& random) {
  return weights == Weights::one ? 1.0 : std::uniform_real_distribution(0.2, 3.0)(random);
}

NurbsSurface<3> random_surface(int p, int q, Weights weights, std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  const KnotVector knots_u = KnotVector::clamped_uniform(p, 2);
  const KnotVector knots_v = KnotVector::clamped_uniform(q, 3);
  HomogeneousPoints<3> net(4, knots_u.basis_count() * knots_v.basis_count());
  for (auto column : net.colwise()) {
    const double w = random_weight(weights, random);
    column << w * coordinate(random), w * coordinate(random), w * coordinate(random), w;
  }
  return {knots_u, knots_v, net};
}

template <int Dim>
NurbsCurve<Dim> random_curve(int p, Weights weights, std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  const KnotVector knots = KnotVector::clamped_uniform(p, 3);
  HomogeneousPoints<Dim> net(Dim + 1, knots.basis_count());
  for (auto column : net.colwise()) {
    const double w = random_weight(weights, random);
    for (int d = 0; d < Dim; ++d) column(d) = w * coordinate(random);
    column(Dim) = w;
  }
  return {knots, net};
}

/// Every pair of degrees that differs in kind, rational and polynomial by turns, both orientations.
Boundary<3> mixed_surfaces() {
  std::mt19937 random(7);
  Boundary<3> boundary;
  for (const auto& [p, q] : std::vector<std::pair<int, int>>{{1, 1},
                                                             {2, 1},
                                                             {1, 3},
                                                             {2, 2},
                                                             {3, 3},
                                                             {2, 4},
                                                             {4, 3},
                                                             {5, 1},
                                                             {6, 7},
                                                             {10, 2},
                                                             {3, 12},
                                                             {20, 18},
                                                             {30, 29}}) {
    for (const Weights weights : {Weights::one, Weights::random}) {
      for (const int orientation : {1, -1}) {
        const std::string name = fmt::format("patch {}", boundary.patches.size());
        boundary.patches.push_back({name, random_surface(p, q, weights, random), orientation});
      }
    }
  }
  return boundary;
}

Boundary<2> mixed_curves() {
  std::mt19937 random(8);
  Boundary<2> boundary;
  for (const int p : {1, 2, 3, 4, 5, 8, 13, 30}) {
    for (const Weights weights : {Weights::one, Weights::random}) {
      for (const int orientation : {1, -1}) {
        const std::string name = fmt::format("patch {}", boundary.patches.size());
        boundary.patches.push_back({name, random_curve<2>(p, weights, random), orientation});
      }
    }
  }
  return boundary;
}

// ---- Files

/// A file name of its own for each test, removed at the end.
class VtuFile : public testing::Test {
 protected:
  VtuFile() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / fmt::format("isorim_{}_{}", info->name(), getpid());
    std::filesystem::create_directories(folder_);
    path_ = folder_ / "shape.vtu";
  }
  ~VtuFile() override { std::filesystem::remove_all(folder_); }

  vtkSmartPointer<vtkUnstructuredGrid> read() const {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(path_.c_str());
    reader->Update();
    EXPECT_EQ(reader->GetErrorCode(), 0UL);
    return reader->GetOutput();
  }
  std::size_t file_count() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator()));
  }

  std::filesystem::path folder_;
  std::filesystem::path path_;
};

using BezierWriter = VtuFile;

/// The cell's point at (r, s), by VTK.
Point3 vtk_point(vtkUnstructuredGrid* grid, vtkIdType cell, double r, double s) {
  vtkNew<vtkGenericCell> generic;
  grid->GetCell(cell, generic);
  std::vector<double> shape_values(static_cast<std::size_t>(generic->GetNumberOfPoints()));
  const std::array<double, 3> at{r, s, 0.0};
  Point3 x;
  int sub_cell = 0;
  generic->EvaluateLocation(sub_cell, at.data(), x.data(), shape_values.data());
  return x;
}

/// The value at (r, s) of a point field with one component, by VTK's shape functions.
double vtk_value(vtkUnstructuredGrid* grid, vtkIdType cell, const char* field, double r, double s) {
  vtkNew<vtkGenericCell> generic;
  grid->GetCell(cell, generic);
  std::vector<double> shape_values(static_cast<std::size_t>(generic->GetNumberOfPoints()));
  const std::array<double, 3> at{r, s, 0.0};
  generic->InterpolateFunctions(at.data(), shape_values.data());
  double value = 0.0;
  for (vtkIdType i = 0; i < generic->GetNumberOfPoints(); ++i) {
    const vtkIdType point = generic->GetPointId(static_cast<int>(i));
    value += shape_values[static_cast<std::size_t>(i)] * grid->GetPointData()->GetArray(field)->GetTuple1(point);
  }
  return value;
}

/// Where the cell's parameter lies in the patch.
double patch_parameter(const geometry::Interval& domain, double s) {
  return domain.first + s * domain.length();
}

Point3 exact_point(const Boundary<3>& boundary, const geometry::BezierElement<3>& element, double r, double s) {
  const double first = element.orientation < 0 ? 1.0 - r : r;
  return evaluate(geometry::surface_of(boundary.patches[static_cast<std::size_t>(element.patch)].shape),
                  {patch_parameter(element.domain[0], first), patch_parameter(element.domain[1], s)});
}

Point3 exact_point(const Boundary<2>& boundary, const geometry::BezierElement<2>& element, double r, double) {
  const double first = element.orientation < 0 ? 1.0 - r : r;
  const Point2 x = evaluate(boundary.patches[static_cast<std::size_t>(element.patch)].shape,
                            patch_parameter(element.domain[0], first));
  return {x.x(), x.y(), 0.0};
}

/// The largest distance between the cells and the patches at random points, relative to the boundary's size.
template <int Dim>
double largest_error(const Boundary<Dim>& boundary, const ElementTable<Dim>& table, vtkUnstructuredGrid* grid) {
  EXPECT_EQ(grid->GetNumberOfCells(), static_cast<vtkIdType>(table.elements.size()));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit;
  double error = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < table.elements.size(); ++i) {
    for (int k = 0; k < 20; ++k) {
      const double r = unit(random);
      const double s = unit(random);
      const Point3 exact = exact_point(boundary, table.elements[i], r, s);
      error = std::max(error, (vtk_point(grid, static_cast<vtkIdType>(i), r, s) - exact).norm());
      size = std::max(size, exact.norm());
    }
  }
  EXPECT_GT(size, 0.0);
  return error / size;
}

template <int Dim>
double largest_error(const Boundary<Dim>& boundary, vtkUnstructuredGrid* grid) {
  return largest_error(boundary, bezier_elements(boundary), grid);
}

// ---- Exactness

TEST_F(BezierWriter, CellsAreQuadrics) {
  for (const Boundary<3>& boundary :
       {geometry::sphere(radius), reversed(geometry::sphere(radius), -1), geometry::torus(major_radius, minor_radius),
        reversed(geometry::torus(major_radius, minor_radius), -1), geometry::cylinder(1.0, 3.0, {1.0, 2.0, 3.0}),
        geometry::cone(2.0, 0.0, 1.0), geometry::box({1.0, 2.0, 3.0})}) {
    write_vtu(path_, bezier_elements(boundary));
    EXPECT_LT(largest_error(boundary, read()), 1e-12) << boundary.patches[0].name;
  }
}

TEST_F(BezierWriter, CellsAreSurfacesOfMixedDegreesAndWeights) {
  const Boundary<3> boundary = mixed_surfaces();
  write_vtu(path_, bezier_elements(boundary));
  EXPECT_LT(largest_error(boundary, read()), 1e-12);
}

TEST_F(BezierWriter, CellsAreElementsOfExtractedSurfaces) {
  for (const Boundary<3>& boundary : {mixed_surfaces(), geometry::torus(major_radius, minor_radius)}) {
    Boundary<3> extracted = geometry::testing::extracted(boundary);
    auto& first = std::get<geometry::ExtractedSurface>(extracted.patches[0].shape);
    first = geometry::testing::cut_element(geometry::testing::cut_element(first, 1, 0, 0.3), 1, 1, 0.6);
    const ElementTable<3> table = bezier_elements(extracted);
    write_vtu(path_, table);
    EXPECT_LT(largest_error(boundary, table, read()), 1e-12);
  }
}

/// Where rows do not sum to one the cell is rational: the surface divides by the sum.
TEST_F(BezierWriter, CellsDivideBySumsOfFunctionsThatAreNotOne) {
  Boundary<3> boundary = geometry::testing::extracted(geometry::box({1.0, 2.0, 3.0}));
  const auto& whole = std::get<geometry::ExtractedSurface>(boundary.patches[0].shape);
  std::vector<geometry::ExtractionElement> elements = whole.elements();
  elements[0].rows(1, 1) = 0.9;
  elements[0].rows(2, 0) = 0.05;
  const geometry::ExtractedSurface surface(whole.homogeneous(), elements);
  boundary.patches = {{"face", surface, 1}};
  write_vtu(path_, bezier_elements(boundary));
  const auto grid = read();
  for (const auto& [r, s] : {std::pair(0.0, 0.0), std::pair(1.0, 0.0), std::pair(0.3, 0.8)}) {
    const Eigen::Vector4d bernstein((1 - r) * (1 - s), r * (1 - s), (1 - r) * s, r * s);
    const Eigen::Vector4d functions = elements[0].rows * bernstein;
    const Eigen::Vector4d sum = surface.homogeneous() * functions;
    EXPECT_LT((vtk_point(grid, 0, r, s) - sum.head<3>() / functions.sum()).norm(), 1e-14);
  }
}

TEST_F(BezierWriter, CellsAreCurvesOfMixedDegreesAndWeights) {
  const Boundary<2> boundary = mixed_curves();
  write_vtu(path_, bezier_elements(boundary));
  const auto grid = read();
  EXPECT_LT(largest_error(boundary, grid), 1e-12);
  EXPECT_EQ(grid->GetCellType(0), VTK_BEZIER_CURVE);
}

TEST_F(BezierWriter, SpaceCurvesAreTheirSegments) {
  std::mt19937 random(9);
  const std::vector<NurbsCurve<3>> curves{random_curve<3>(1, Weights::one, random),
                                          random_curve<3>(3, Weights::random, random),
                                          random_curve<3>(6, Weights::random, random)};
  const std::vector<std::string> names{"a", "b", "c"};
  write_curves_vtu<3>(path_, curves, names);
  const auto grid = read();
  ASSERT_EQ(grid->GetNumberOfCells(), 9);
  std::uniform_real_distribution<double> unit;
  for (vtkIdType cell = 0; cell < 9; ++cell) {
    const auto curve = static_cast<std::size_t>(grid->GetCellData()->GetArray("patch")->GetTuple1(cell));
    const double segment = grid->GetCellData()->GetArray("element")->GetTuple1(cell);
    EXPECT_EQ(static_cast<vtkIdType>(curve) * 3 + static_cast<vtkIdType>(segment), cell);
    for (int k = 0; k < 20; ++k) {
      const double r = unit(random);
      EXPECT_LT((vtk_point(grid, cell, r, 0.0) - evaluate(curves[curve], (segment + r) / 3.0)).norm(), 1e-12);
    }
  }
}

TEST_F(BezierWriter, PlaneCurvesLieInThePlane) {
  const std::vector<NurbsCurve<2>> curves{geometry::circle_curve(1.0)};
  write_curves_vtu<2>(path_, curves);
  const auto grid = read();
  ASSERT_EQ(grid->GetNumberOfCells(), 4);
  for (vtkIdType cell = 0; cell < 4; ++cell) {
    const Point3 x = vtk_point(grid, cell, 0.3, 0.0);
    EXPECT_NEAR(x.head<2>().norm(), 1.0, 1e-15);
    EXPECT_EQ(x.z(), 0.0);
  }
}

TEST_F(BezierWriter, PolynomialPointsAreStoredBitForBit) {
  std::mt19937 random(3);
  const Boundary<3> boundary{{{"patch", random_surface(2, 3, Weights::one, random), 1}}};
  const ElementTable<3> table = bezier_elements(boundary);
  write_vtu(path_, table);
  const auto grid = read();
  ASSERT_EQ(grid->GetPoints()->GetDataType(), VTK_DOUBLE);
  // Corners: (0, 0), (p, 0), (p, q), (0, q).
  const auto net = table.net_matrix(table.elements[0]);
  const std::array corners{0, 2, 11, 9};
  for (vtkIdType i = 0; i < 4; ++i) {
    Point3 x;
    grid->GetPoint(i, x.data());
    EXPECT_EQ(x, net.col(corners[static_cast<std::size_t>(i)]).head<3>());
  }
}

// ---- Tessellation by VTK

using Distance = double (*)(const Point3&);

/// What ParaView draws.
vtkSmartPointer<vtkPolyData> tessellated(vtkUnstructuredGrid* grid) {
  vtkNew<vtkDataSetSurfaceFilter> filter;
  filter->SetInputData(grid);
  filter->SetNonlinearSubdivisionLevel(3);
  filter->Update();
  return filter->GetOutput();
}

double largest_distance(vtkPolyData* mesh, Distance distance) {
  double largest = 0.0;
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i) {
    Point3 x;
    mesh->GetPoint(i, x.data());
    largest = std::max(largest, distance(x));
  }
  return largest;
}

TEST_F(BezierWriter, TessellationLiesOnTheSphereAndTheTorus) {
  write_vtu(path_, bezier_elements(geometry::sphere(radius)));
  const auto sphere_mesh = tessellated(read());
  EXPECT_GT(sphere_mesh->GetNumberOfPoints(), 8 * 25);
  EXPECT_LT(largest_distance(sphere_mesh, distance_to_sphere), 1e-6);
  write_vtu(path_, bezier_elements(reversed(geometry::torus(major_radius, minor_radius), -1)));
  const auto torus_mesh = tessellated(read());
  EXPECT_GT(torus_mesh->GetNumberOfPoints(), 16 * 25);
  EXPECT_LT(largest_distance(torus_mesh, distance_to_torus), 1e-6);
}

/// Twice the area of the mesh's polygons, those whose normal points along `outward` counted positive.
double signed_double_area(vtkPolyData* mesh, const std::function<Vector3(const Point3&)>& outward) {
  double sum = 0.0;
  for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i) {
    vtkPoints* points = mesh->GetCell(i)->GetPoints();
    std::array<Point3, 3> x;
    for (int k = 0; k < 3; ++k) points->GetPoint(k, x[static_cast<std::size_t>(k)].data());
    const Vector3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
    sum += normal.norm() * (normal.dot(outward((x[0] + x[1] + x[2]) / 3.0)) >= 0.0 ? 1.0 : -1.0);
  }
  return sum;
}

TEST_F(BezierWriter, EveryCellShowsItsOutwardSide) {
  const auto outward = [](const Point3& x) -> Vector3 { return x; };
  const double area = 4.0 * std::numbers::pi * radius * radius;
  const Boundary<3> sphere = geometry::sphere(radius);
  for (const Boundary<3>& boundary : {sphere, reversed(sphere, -1)}) {
    write_vtu(path_, bezier_elements(boundary));
    EXPECT_NEAR(signed_double_area(tessellated(read()), outward), 2.0 * area, 0.02 * area);
  }
  write_vtu(path_, bezier_elements(reversed(sphere, 1)));
  EXPECT_NEAR(signed_double_area(tessellated(read()), outward), -2.0 * area, 0.02 * area) << "inside out";
}

// ---- What else the file says

TEST_F(BezierWriter, WeightsAndDegreesAreAttributes) {
  const Boundary<3> boundary = mixed_surfaces();
  const ElementTable<3> table = bezier_elements(boundary);
  write_vtu(path_, table);
  const auto grid = read();
  ASSERT_NE(grid->GetPointData()->GetRationalWeights(), nullptr);
  vtkDataArray* degrees = grid->GetCellData()->GetHigherOrderDegrees();
  ASSERT_NE(degrees, nullptr);
  for (std::size_t i = 0; i < table.elements.size(); ++i) {
    const double* tuple = degrees->GetTuple3(static_cast<vtkIdType>(i));
    EXPECT_EQ(tuple[0], table.elements[i].degree[0]);
    EXPECT_EQ(tuple[1], table.elements[i].degree[1]);
    EXPECT_EQ(tuple[2], 0.0);
  }
}

TEST_F(BezierWriter, CellsNameTheirPatchElementAndOrientation) {
  const Boundary<3> boundary = mixed_surfaces();
  const ElementTable<3> table = bezier_elements(boundary);
  std::vector<std::string> names;
  for (const auto& patch : boundary.patches) names.push_back(patch.name);
  write_vtu(path_, table, {.patch_names = names, .point_fields = {}, .cell_fields = {}});
  const auto grid = read();
  vtkCellData* data = grid->GetCellData();
  for (std::size_t i = 0; i < table.elements.size(); ++i) {
    const auto cell = static_cast<vtkIdType>(i);
    EXPECT_EQ(data->GetArray("patch")->GetTuple1(cell), table.elements[i].patch);
    EXPECT_EQ(data->GetArray("element")->GetTuple1(cell), static_cast<double>(i));
    EXPECT_EQ(data->GetArray("orientation")->GetTuple1(cell), table.elements[i].orientation);
  }
  auto* read_names = vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray("patch_names"));
  ASSERT_NE(read_names, nullptr);
  ASSERT_EQ(read_names->GetNumberOfValues(), static_cast<vtkIdType>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(read_names->GetValue(static_cast<vtkIdType>(i)), names[i]);
  }
}

TEST_F(BezierWriter, PointFieldsAreControlValuesInTheElementsOwnBasis) {
  // A linear function of the place has its values at the control points as control values.
  const Boundary<3> boundary = mixed_surfaces();
  const ElementTable<3> table = bezier_elements(boundary);
  const auto linear = [](const Point3& x) { return 1.0 + 2.0 * x.x() - 3.0 * x.y() + 0.5 * x.z(); };
  std::vector<double> heights;
  std::vector<double> places;
  for (const auto& element : table.elements) {
    const auto net = table.net_matrix(element);
    for (Eigen::Index k = 0; k < net.cols(); ++k) {
      const Point3 x = net.col(k).head<3>() / net(3, k);
      heights.push_back(linear(x));
      places.insert(places.end(), x.begin(), x.end());
    }
  }
  std::vector<double> indices(table.elements.size());
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = 0.5 * static_cast<double>(i);
  write_vtu(path_, table,
            {.patch_names = {},
             .point_fields = {{"height", 1, heights}, {"place", 3, places}},
             .cell_fields = {{"half index", 1, indices}}});
  const auto grid = read();
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell) {
    EXPECT_NEAR(vtk_value(grid, cell, "height", 0.3, 0.8), linear(vtk_point(grid, cell, 0.3, 0.8)), 1e-12);
    EXPECT_EQ(grid->GetCellData()->GetArray("half index")->GetTuple1(cell), 0.5 * static_cast<double>(cell));
  }
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i) {
    Point3 x;
    grid->GetPoint(i, x.data());
    const double* place = grid->GetPointData()->GetArray("place")->GetTuple3(i);
    EXPECT_EQ(x, Point3(place[0], place[1], place[2]));
  }
}

TEST_F(BezierWriter, AnEmptyTableIsAnEmptyFile) {
  write_vtu(path_, ElementTable<3>{});
  EXPECT_EQ(read()->GetNumberOfCells(), 0);
}

// ---- Failure

template <class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(BezierWriter, RefusesFieldsThatDoNotFit) {
  const ElementTable<3> table = bezier_elements(geometry::sphere(radius));
  const std::vector<double> values(8);
  const auto with_point_field = [&](const VtuField& field) {
    return message_of([&] { write_vtu(path_, table, {{}, {field}, {}}); });
  };
  EXPECT_THAT(with_point_field({"f", 1, values}), testing::HasSubstr("'f' has 8 values, expected 72"));
  EXPECT_THAT(with_point_field({"f", 1, values}), testing::HasSubstr(path_.string()));
  EXPECT_THAT(with_point_field({"f", 0, values}), testing::HasSubstr("'f' has 0 components"));
  EXPECT_THAT(with_point_field({"RationalWeights", 1, values}), testing::HasSubstr("'RationalWeights' is taken"));
  EXPECT_THAT(message_of([&] {
                write_vtu(path_, table, {{}, {}, {{"g", 2, values}}});
              }),
              testing::HasSubstr("'g' has 8 values, expected 16"));
  EXPECT_THAT(message_of([&] {
                write_vtu(path_, table, {{}, {}, {{"g", 1, values}, {"g", 1, values}}});
              }),
              testing::HasSubstr("'g' is taken"));
  EXPECT_EQ(file_count(), 0U);
}

TEST_F(BezierWriter, AFolderThatIsMissingIsNamed) {
  const auto path = folder_ / "missing" / "shape.vtu";
  EXPECT_THAT(message_of([&] { write_vtu(path, ElementTable<3>{}); }),
              testing::AllOf(testing::HasSubstr(path.string()), testing::HasSubstr("No such file or directory")));
}

/// As on a full disk: no file of this process may grow beyond `bytes` while this lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_F(BezierWriter, AFullDiskLeavesTheOldFileAlone) {
  const ElementTable<3> table = bezier_elements(mixed_surfaces());
  std::ofstream(path_) << "old";
  std::string message;
  {
    const FileSizeLimit limit(20000);
    message = message_of([&] { write_vtu(path_, table); });
  }
  EXPECT_THAT(message, testing::HasSubstr(path_.string()));
  EXPECT_EQ(file_count(), 1U);
  EXPECT_EQ(std::filesystem::file_size(path_), 3U);
  write_vtu(path_, table);
  EXPECT_EQ(file_count(), 1U);
  EXPECT_GT(std::filesystem::file_size(path_), 20000U);
}

}  // namespace
}  // namespace isorim::io
