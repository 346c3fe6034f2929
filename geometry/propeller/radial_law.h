#pragma once

#include <string_view>
#include <vector>

namespace isorim::geometry {

/// A quantity of a blade against r / R: one value for all radii, or a table. Between the rows of a table it is the
/// cubic that keeps rising data rising and goes beyond no row (Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5, 1984);
/// outside the table it continues along the end's slope.
class RadialLaw {
 public:
  explicit RadialLaw(double constant = 0.0) : radii_{0.0}, values_{constant}, slopes_{0.0} {}
  /// Throws GeometryError naming `quantity` if the counts differ, there is no row, a number is not finite, or the radii
  /// do not rise.
  RadialLaw(std::string_view quantity, std::vector<double> radii, std::vector<double> values);

  double operator()(double radius_ratio) const;
  bool is_constant() const { return radii_.size() == 1; }

 private:
  std::vector<double> radii_;
  std::vector<double> values_;
  std::vector<double> slopes_;
};

}  // namespace isorim::geometry
