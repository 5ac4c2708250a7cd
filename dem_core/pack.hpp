// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
// Pack<W>: W doubles, one per lane (parameter set). Private to dem_core kernels.
//
// W = 1 is a plain double and the reference. W = 4 exists where the translation unit is compiled
// for AVX2, W = 8 for AVX-512F. Every operation is the IEEE one, lane by lane: no fused multiply-add,
// no approximate reciprocal, so a lane carries the same bits at any W.
#pragma once

#include <cmath>
#if defined(__AVX2__)
#include <immintrin.h>
#endif

#define TILTH_INLINE __attribute__((always_inline)) inline

namespace tilth::lanes {

template <int W>
struct Mask;
template <int W>
struct Pack;

template <>
struct Mask<1> {
  bool m;
};

template <>
struct Pack<1> {
  double v;
  TILTH_INLINE static Pack load(const double* p) { return {*p}; }
  TILTH_INLINE static Pack all(double s) { return {s}; }
  TILTH_INLINE void store(double* p) const { *p = v; }
};

TILTH_INLINE Pack<1> operator+(Pack<1> a, Pack<1> b) { return {a.v + b.v}; }
TILTH_INLINE Pack<1> operator-(Pack<1> a, Pack<1> b) { return {a.v - b.v}; }
TILTH_INLINE Pack<1> operator*(Pack<1> a, Pack<1> b) { return {a.v * b.v}; }
TILTH_INLINE Pack<1> operator/(Pack<1> a, Pack<1> b) { return {a.v / b.v}; }
TILTH_INLINE Mask<1> operator<(Pack<1> a, Pack<1> b) { return {a.v < b.v}; }
TILTH_INLINE Mask<1> operator>(Pack<1> a, Pack<1> b) { return {a.v > b.v}; }
TILTH_INLINE Mask<1> operator&(Mask<1> a, Mask<1> b) { return {a.m && b.m}; }
TILTH_INLINE Mask<1> operator|(Mask<1> a, Mask<1> b) { return {a.m || b.m}; }
TILTH_INLINE Mask<1> operator!(Mask<1> a) { return {!a.m}; }
TILTH_INLINE bool any(Mask<1> a) { return a.m; }
TILTH_INLINE Pack<1> select(Mask<1> m, Pack<1> a, Pack<1> b) { return {m.m ? a.v : b.v}; }
TILTH_INLINE Pack<1> sqrt(Pack<1> a) { return {__builtin_sqrt(a.v)}; }
TILTH_INLINE Pack<1> abs(Pack<1> a) { return {__builtin_fabs(a.v)}; }

#if defined(__AVX2__)
template <>
struct Mask<4> {
  __m256d m;
};

template <>
struct Pack<4> {
  __m256d v;
  TILTH_INLINE static Pack load(const double* p) { return {_mm256_load_pd(p)}; }
  TILTH_INLINE static Pack all(double s) { return {_mm256_set1_pd(s)}; }
  TILTH_INLINE void store(double* p) const { _mm256_store_pd(p, v); }
};

TILTH_INLINE Pack<4> operator+(Pack<4> a, Pack<4> b) { return {_mm256_add_pd(a.v, b.v)}; }
TILTH_INLINE Pack<4> operator-(Pack<4> a, Pack<4> b) { return {_mm256_sub_pd(a.v, b.v)}; }
TILTH_INLINE Pack<4> operator*(Pack<4> a, Pack<4> b) { return {_mm256_mul_pd(a.v, b.v)}; }
TILTH_INLINE Pack<4> operator/(Pack<4> a, Pack<4> b) { return {_mm256_div_pd(a.v, b.v)}; }
TILTH_INLINE Mask<4> operator<(Pack<4> a, Pack<4> b) {
  return {_mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ)};
}
TILTH_INLINE Mask<4> operator>(Pack<4> a, Pack<4> b) {
  return {_mm256_cmp_pd(a.v, b.v, _CMP_GT_OQ)};
}
TILTH_INLINE Mask<4> operator&(Mask<4> a, Mask<4> b) { return {_mm256_and_pd(a.m, b.m)}; }
TILTH_INLINE Mask<4> operator|(Mask<4> a, Mask<4> b) { return {_mm256_or_pd(a.m, b.m)}; }
TILTH_INLINE Mask<4> operator!(Mask<4> a) {
  return {_mm256_xor_pd(a.m, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)))};
}
TILTH_INLINE bool any(Mask<4> a) { return _mm256_movemask_pd(a.m) != 0; }
TILTH_INLINE Pack<4> select(Mask<4> m, Pack<4> a, Pack<4> b) {
  return {_mm256_blendv_pd(b.v, a.v, m.m)};
}
TILTH_INLINE Pack<4> sqrt(Pack<4> a) { return {_mm256_sqrt_pd(a.v)}; }
TILTH_INLINE Pack<4> abs(Pack<4> a) {
  return {_mm256_andnot_pd(_mm256_set1_pd(-0.0), a.v)};
}
#endif

#if defined(__AVX512F__)
template <>
struct Mask<8> {
  __mmask8 m;
};

template <>
struct Pack<8> {
  __m512d v;
  TILTH_INLINE static Pack load(const double* p) { return {_mm512_load_pd(p)}; }
  TILTH_INLINE static Pack all(double s) { return {_mm512_set1_pd(s)}; }
  TILTH_INLINE void store(double* p) const { _mm512_store_pd(p, v); }
};
static_assert(sizeof(Pack<8>) == 64, "eight lanes must be one native register");

TILTH_INLINE Pack<8> operator+(Pack<8> a, Pack<8> b) { return {_mm512_add_pd(a.v, b.v)}; }
TILTH_INLINE Pack<8> operator-(Pack<8> a, Pack<8> b) { return {_mm512_sub_pd(a.v, b.v)}; }
TILTH_INLINE Pack<8> operator*(Pack<8> a, Pack<8> b) { return {_mm512_mul_pd(a.v, b.v)}; }
TILTH_INLINE Pack<8> operator/(Pack<8> a, Pack<8> b) { return {_mm512_div_pd(a.v, b.v)}; }
TILTH_INLINE Mask<8> operator<(Pack<8> a, Pack<8> b) {
  return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ)};
}
TILTH_INLINE Mask<8> operator>(Pack<8> a, Pack<8> b) {
  return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_GT_OQ)};
}
TILTH_INLINE Mask<8> operator&(Mask<8> a, Mask<8> b) {
  return {static_cast<__mmask8>(a.m & b.m)};
}
TILTH_INLINE Mask<8> operator|(Mask<8> a, Mask<8> b) {
  return {static_cast<__mmask8>(a.m | b.m)};
}
TILTH_INLINE Mask<8> operator!(Mask<8> a) { return {static_cast<__mmask8>(~a.m)}; }
TILTH_INLINE bool any(Mask<8> a) { return a.m != 0; }
TILTH_INLINE Pack<8> select(Mask<8> m, Pack<8> a, Pack<8> b) {
  return {_mm512_mask_blend_pd(m.m, b.v, a.v)};
}
TILTH_INLINE Pack<8> sqrt(Pack<8> a) { return {_mm512_sqrt_pd(a.v)}; }
TILTH_INLINE Pack<8> abs(Pack<8> a) { return {_mm512_abs_pd(a.v)}; }
#endif

template <int W>
struct Pack3 {
  Pack<W> x, y, z;
  TILTH_INLINE static Pack3 load(const double* p) {
    return {Pack<W>::load(p), Pack<W>::load(p + W), Pack<W>::load(p + 2 * W)};
  }
  TILTH_INLINE static Pack3 zero() {
    const Pack<W> o = Pack<W>::all(0.0);
    return {o, o, o};
  }
  TILTH_INLINE void store(double* p) const {
    x.store(p);
    y.store(p + W);
    z.store(p + 2 * W);
  }
};

template <int W>
TILTH_INLINE Pack3<W> operator+(const Pack3<W>& a, const Pack3<W>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <int W>
TILTH_INLINE Pack3<W> operator-(const Pack3<W>& a, const Pack3<W>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <int W>
TILTH_INLINE Pack3<W> operator*(Pack<W> s, const Pack3<W>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <int W>
TILTH_INLINE Pack<W> dot(const Pack3<W>& a, const Pack3<W>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <int W>
TILTH_INLINE Pack3<W> cross(const Pack3<W>& a, const Pack3<W>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <int W>
TILTH_INLINE Pack3<W> select(Mask<W> m, const Pack3<W>& a, const Pack3<W>& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

}  // namespace tilth::lanes
