#include "io/stl/stl_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/errors.h"
#include "io/atomic_file.h"

namespace isorim::io {
namespace {

using Corner = std::array<float, 3>;

constexpr std::size_t header_size = 80;

/// Little-endian whatever the machine.
void append(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>((value >> shift) & 0xffU));
}
void append(std::string& bytes, float value) {
  append(bytes, std::bit_cast<std::uint32_t>(value));
}

Corner corner(const geometry::TriangleMesh& mesh, int vertex) {
  Corner result{};
  for (Eigen::Index i = 0; i < 3; ++i) {
    result[static_cast<std::size_t>(i)] = static_cast<float>(mesh.vertices(i, vertex));
    if (!std::isfinite(result[static_cast<std::size_t>(i)]))
      throw InputError(fmt::format("an STL file cannot hold the coordinate {}", mesh.vertices(i, vertex)));
  }
  return result;
}

/// Zero for triangles without area in double precision: readers make their own then.
geometry::Vector3 normal_of(const geometry::TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const geometry::Point3 a = mesh.vertices.col(triangle[0]);
  const geometry::Vector3 normal = (mesh.vertices.col(triangle[1]) - a).cross(mesh.vertices.col(triangle[2]) - a);
  return normal.norm() > 0.0 ? normal.normalized() : normal;
}

std::string header(std::string_view title) {
  // Files that begin with "solid" are taken for text.
  std::string text = fmt::format("isorim: {}", title).substr(0, header_size);
  text.resize(header_size, ' ');
  return text;
}

}  // namespace

std::size_t write_stl(const std::filesystem::path& path, std::string_view title, const geometry::TriangleMesh& mesh) {
  std::string bytes;
  std::uint32_t count = 0;
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    const std::array<Corner, 3> corners{corner(mesh, triangle[0]), corner(mesh, triangle[1]),
                                        corner(mesh, triangle[2])};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    const geometry::Vector3 normal = normal_of(mesh, triangle);
    for (const double x : normal) append(bytes, static_cast<float>(x));
    for (const Corner& place : corners)
      for (const float x : place) append(bytes, x);
    bytes.append(2, '\0');
    ++count;
  }
  std::string size;
  append(size, count);
  write_file(path, header(title) + size + bytes);
  return count;
}

}  // namespace isorim::io
