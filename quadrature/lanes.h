#pragma once

#include <cstddef>

#include "quadrature/element_sums.h"

// Kernels are compiled for the oldest processor of the platform and, with GCC on x86-64, for AVX2 with FMA as well;
// the processor decides at run time.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__AVX2__)
#define ISORIM_DISPATCH
#endif

/// What the kernels' sources share; included by them alone.
namespace isorim::quadrature {

/// One number for each element of a batch, or for each of a few points. GCC and Clang lower it to whatever registers
/// the target has.
using Lanes = double __attribute__((vector_size(kernel_lanes * sizeof(double))));

struct alignas(Lanes) Packet {
  Lanes value;
};

/// The processor has what the kernels for AVX2 with FMA need.
inline bool has_wide_registers() {
#ifdef ISORIM_DISPATCH
  static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return has;
#else
  return false;
#endif
}

}  // namespace isorim::quadrature
