#include "io/iges/entity_reader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "geometry/shapes/transforms.h"

namespace isorim::io::iges {

using geometry::AffineMap;
using geometry::Point3;
using geometry::Points;
using geometry::Vector3;

namespace {

/// Composite curves in composite curves, placements of placements: no program nests deeper by intent.
constexpr std::size_t deepest_nesting = 100;

/// What the smallest entity takes, in numbers.
constexpr std::size_t entity_overhead = 32;
constexpr std::size_t least_largest_size = 10'000'000;

/// The colours that have a number of their own, from 1 on.
constexpr std::array<Colour, 8> numbered_colours{{{0.0, 0.0, 0.0},
                                                  {1.0, 0.0, 0.0},
                                                  {0.0, 1.0, 0.0},
                                                  {0.0, 0.0, 1.0},
                                                  {1.0, 1.0, 0.0},
                                                  {1.0, 0.0, 1.0},
                                                  {0.0, 1.0, 1.0},
                                                  {1.0, 1.0, 1.0}}};

}  // namespace

double extent(const Points<3>& points) {
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

EntityReader::Visit::Visit(EntityReader& reader, const Entity& entity) : reader_(reader), sequence_(entity.sequence) {
  if (reader.active_.size() >= deepest_nesting)
    reader.refuse(entity, fmt::format("nested deeper than {} entities", deepest_nesting));
  if (!reader.active_.insert(sequence_).second) reader.refuse(entity, "refers to itself, directly or through others");
}

EntityReader::Visit::~Visit() {
  reader_.active_.erase(sequence_);
}

EntityReader::EntityReader(const File& file, const IgesOptions& options)
    : file_(file), options_(options), largest_size_(options.largest_size) {
  if (largest_size_ > 0) return;
  std::size_t numbers = 0;
  for (const Entity& entity : file.entities) numbers += entity.tokens.size() + entity_overhead;
  largest_size_ = std::max(least_largest_size, 50 * numbers);
}

void EntityReader::charge(const Entity& entity, std::size_t numbers) {
  charged_ += numbers + entity_overhead;
  if (charged_ > largest_size_)
    refuse(entity, fmt::format("up to here the entities, written out as often as they are used, amount to more than {} "
                               "numbers",
                               largest_size_));
}

void EntityReader::remark(const std::string& kind, const Entity& entity) {
  Occurrences& occurrences = remarks_[kind];
  if (occurrences.count++ == 0) occurrences.first = entity_text(entity);
}

void EntityReader::approximation(const Entity& entity, const std::string& description, double tolerance,
                                 double deviation) {
  if (tolerance <= 0.0) return;
  approximations_.push_back({.entity = fmt::format("{} ({}) at D{}", entity.type, description, entity.sequence),
                             .tolerance = tolerance,
                             .deviation = deviation});
}

void EntityReader::fitted_pcurves(const Entity& entity, int count, double tolerance, double deviation) {
  fitted_pcurves_ += count;
  if (deviation < worst_pcurve_.deviation) return;
  worst_pcurve_ = {.entity = entity_text(entity), .tolerance = tolerance, .deviation = deviation};
}

std::vector<Approximation> EntityReader::approximations() const {
  std::vector<Approximation> result = approximations_;
  if (fitted_pcurves_ == 0) return result;
  Approximation pcurves = worst_pcurve_;
  pcurves.entity = fmt::format("{} curves in the parameters of round surfaces, the worst on {}", fitted_pcurves_,
                               worst_pcurve_.entity);
  result.push_back(std::move(pcurves));
  return result;
}

std::vector<std::string> EntityReader::warnings() const {
  std::vector<std::string> result;
  for (const auto& [kind, occurrences] : remarks_)
    result.push_back(occurrences.count == 1
                         ? fmt::format("{}: {}", occurrences.first, kind)
                         : fmt::format("{} and {} more: {}", occurrences.first, occurrences.count - 1, kind));
  return result;
}

AffineMap<3> EntityReader::placement(const Entity& entity) {
  AffineMap<3> result;
  const Entity* current = &entity;
  for (std::size_t depth = 0; current->transformation != 0; ++depth) {
    const Entity* matrix = file_.find(current->transformation);
    if (matrix == nullptr || matrix->type != 124)
      refuse(*current, fmt::format("its transformation should be a 124; D{} is {}", current->transformation,
                                   matrix == nullptr ? "not there" : entity_text(*matrix)));
    if (depth >= deepest_nesting) refuse(entity, "its transformations refer to each other without end");
    Parameters p(file_, *matrix);
    AffineMap<3> step;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) step.linear(row, column) = p.real();
      step.translation(row) = p.real();
    }
    if (step.linear.determinant() == 0.0) refuse(*matrix, "its matrix is singular");
    const Eigen::Matrix3d rest = step.linear.transpose() * step.linear - Eigen::Matrix3d::Identity();
    if (rest.cwiseAbs().maxCoeff() > 1e-4) remark("its matrix is no rotation; it is applied as it stands", *matrix);
    result = geometry::compose(step, result);
    current = matrix;
  }
  return result;
}

Point3 EntityReader::point(const Entity& entity) {
  if (entity.type != 116) refuse(entity, "a point (116) is expected here");
  Parameters p(file_, entity);
  const double x = p.real();
  const double y = p.real();
  const double z = p.real();
  return placement(entity)(Point3(x, y, z));
}

Vector3 EntityReader::direction(const Entity& entity) {
  if (entity.type != 123) refuse(entity, "a direction (123) is expected here");
  Parameters p(file_, entity);
  const double x = p.real();
  const double y = p.real();
  const double z = p.real();
  const Vector3 result(x, y, z);
  if (!(result.stableNorm() > 0.0)) refuse(entity, "the direction is zero");
  return result;
}

std::optional<Colour> EntityReader::colour(const Entity& entity) {
  if (entity.colour > 0 && entity.colour <= static_cast<int>(numbered_colours.size()))
    return numbered_colours[static_cast<std::size_t>(entity.colour) - 1];
  if (entity.colour >= 0) return std::nullopt;
  const Entity* definition = file_.find(-entity.colour);
  if (definition == nullptr || definition->type != 314 || !definition->complaint.empty()) {
    remark("its colour is no colour definition (314) that can be read", entity);
    return std::nullopt;
  }
  Parameters p(file_, *definition);
  Colour result{};
  for (double& channel : result) channel = std::clamp(0.01 * p.real(0.0), 0.0, 1.0);
  return result;
}

int EntityReader::level(const Entity& entity) {
  if (entity.level >= 0) return entity.level;
  const Entity* list = file_.find(-entity.level);
  if (list == nullptr || list->type != 406 || list->form != 1 || !list->complaint.empty()) return 0;
  Parameters p(file_, *list);
  return p.integer(0) > 0 ? p.integer(0) : 0;
}

std::string EntityReader::name(Parameters& parameters) {
  const TrailingPointers trailing = parameters.trailing_pointers();
  if (!trailing.complaint.empty()) remark(trailing.complaint, parameters.entity());
  for (const int pointer : trailing.properties) {
    const Entity* property = file_.find(pointer);
    if (property == nullptr || property->type != 406 || property->form != 15 || !property->complaint.empty()) continue;
    Parameters p(file_, *property);
    if (p.integer(0) >= 1) return p.text(std::string());
  }
  return {};
}

std::string EntityReader::spline_name(const Entity& entity) {
  if (entity.type != 126 && entity.type != 128) return {};
  Parameters p(file_, entity);
  // Flags, knots, four numbers a point, and what stands behind them: ranges, and a curve's normal.
  long left = 0;
  if (entity.type == 126) {
    const long points = p.integer() + 1L;
    const long knots = points + p.integer() + 1L;
    left = 4 + knots + 4 * points + 5;
  } else {
    const long points_u = p.integer() + 1L;
    const long points_v = p.integer() + 1L;
    const long knots_u = points_u + p.integer() + 1L;
    const long knots_v = points_v + p.integer() + 1L;
    left = 5 + knots_u + knots_v + 4 * points_u * points_v + 4;
  }
  if (left < 0 || left > p.remaining()) return {};
  p.skip(static_cast<int>(left));
  return name(p);
}

}  // namespace isorim::io::iges
