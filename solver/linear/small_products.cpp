#include "solver/linear/small_products.h"

#include <algorithm>
#include <cstring>

#include "quadrature/lanes.h"

namespace isorim::solver {

namespace {

using quadrature::Lanes;
static_assert(product_lanes == quadrature::kernel_lanes);

struct ProductSet {
  void (*product)(int, int, int, const SteppedMatrix&, const double*, std::ptrdiff_t, double*, std::ptrdiff_t);
  void (*transposed)(int, int, int, const double*, std::ptrdiff_t, const double*, std::ptrdiff_t, double*,
                     std::ptrdiff_t);
  void (*bernstein)(int, int, const double*, double*, std::ptrdiff_t);
};

namespace baseline {
#include "solver/linear/small_products_kernels.inc"
}  // namespace baseline

#ifdef ISORIM_DISPATCH
#pragma GCC push_options
#pragma GCC target("arch=haswell")
namespace haswell {
#include "solver/linear/small_products_kernels.inc"
}  // namespace haswell
#pragma GCC pop_options

const ProductSet& products() {
  return quadrature::has_wide_registers() ? haswell::products : baseline::products;
}
#else
const ProductSet& products() {
  return baseline::products;
}
#endif

}  // namespace

void add_product(int m, int n, int k, const SteppedMatrix& a, const double* b, std::ptrdiff_t b_step, double* c,
                 std::ptrdiff_t c_step) {
  products().product(m, n, k, a, b, b_step, c, c_step);
}

void add_product_transposed(int m, int n, int k, const double* a, std::ptrdiff_t a_step, const double* b,
                            std::ptrdiff_t b_step, double* c, std::ptrdiff_t c_step) {
  products().transposed(m, n, k, a, a_step, b, b_step, c, c_step);
}

void bernstein_values(int degree, int count, const double* places, double* values, std::ptrdiff_t step) {
  products().bernstein(degree, count, places, values, step);
}

}  // namespace isorim::solver
