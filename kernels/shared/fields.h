// SPDX-License-Identifier: MIT
// List of the structs that host and kernels share, with the members whose offsets must agree
// (sizes.cl).
//
// CLPV_EACH_SHARED(SIZE, OFFSET) writes SIZE(type) and OFFSET(type, field) in a fixed order.
// Include the headers of the structs before: host and kernels name them by different paths.
#pragma once

// clang-format off
#define CLPV_EACH_SHARED(SIZE, OFFSET)                                                             \
  SIZE(ClpvGrid) OFFSET(ClpvGrid, origin) OFFSET(ClpvGrid, cell) OFFSET(ClpvGrid, n)               \
    OFFSET(ClpvGrid, middle)                                                                       \
  SIZE(ClpvLight) OFFSET(ClpvLight, position) OFFSET(ClpvLight, kind) OFFSET(ClpvLight, direction) \
    OFFSET(ClpvLight, range) OFFSET(ClpvLight, intensity) OFFSET(ClpvLight, cone_scale)            \
    OFFSET(ClpvLight, cone_offset) OFFSET(ClpvLight, narrow_cone) OFFSET(ClpvLight, medium)        \
  SIZE(ClpvMedium) OFFSET(ClpvMedium, lower) OFFSET(ClpvMedium, upper)                             \
    OFFSET(ClpvMedium, scattering) OFFSET(ClpvMedium, extinction) OFFSET(ClpvMedium, anisotropy)   \
  SIZE(ClpvVertex) OFFSET(ClpvVertex, position) OFFSET(ClpvVertex, normal) OFFSET(ClpvVertex, uv)  \
    OFFSET(ClpvVertex, colour)                                                                     \
  SIZE(ClpvTriangle) OFFSET(ClpvTriangle, vertex) OFFSET(ClpvTriangle, material)                   \
  SIZE(ClpvMaterial) OFFSET(ClpvMaterial, base_colour) OFFSET(ClpvMaterial, emissive)              \
    OFFSET(ClpvMaterial, alpha_cutoff) OFFSET(ClpvMaterial, texture)                               \
    OFFSET(ClpvMaterial, emissive_texture) OFFSET(ClpvMaterial, flags)                             \
  SIZE(ClpvTexture) OFFSET(ClpvTexture, offset) OFFSET(ClpvTexture, width)                         \
    OFFSET(ClpvTexture, height) OFFSET(ClpvTexture, wrap)                                          \
  SIZE(ClpvEmitter) OFFSET(ClpvEmitter, triangle) OFFSET(ClpvEmitter, u) OFFSET(ClpvEmitter, v)    \
    OFFSET(ClpvEmitter, size) OFFSET(ClpvEmitter, rows) OFFSET(ClpvEmitter, first)                 \
    OFFSET(ClpvEmitter, side)                                                                      \
  SIZE(ClpvView) OFFSET(ClpvView, eye) OFFSET(ClpvView, orthographic) OFFSET(ClpvView, right)      \
    OFFSET(ClpvView, half_width) OFFSET(ClpvView, up) OFFSET(ClpvView, half_height)                \
    OFFSET(ClpvView, forward) OFFSET(ClpvView, near_depth) OFFSET(ClpvView, width)                 \
    OFFSET(ClpvView, height) OFFSET(ClpvView, far_depth)                                           \
  SIZE(ClpvSweepBin) OFFSET(ClpvSweepBin, plane_sign) OFFSET(ClpvSweepBin, row_sign)               \
    OFFSET(ClpvSweepBin, column_sign) OFFSET(ClpvSweepBin, plane_axis)                             \
    OFFSET(ClpvSweepBin, row_axis) OFFSET(ClpvSweepBin, column_axis) OFFSET(ClpvSweepBin, links)   \
    OFFSET(ClpvSweepBin, transposed) OFFSET(ClpvSweepBin, plane) OFFSET(ClpvSweepBin, row)         \
  SIZE(ClpvSweepDirection) OFFSET(ClpvSweepDirection, taps) OFFSET(ClpvSweepDirection, share)      \
    OFFSET(ClpvSweepDirection, from_coarser) OFFSET(ClpvSweepDirection, coarser)                   \
    OFFSET(ClpvSweepDirection, attenuation)                                                        \
  SIZE(ClpvSweepHalo) OFFSET(ClpvSweepHalo, first) OFFSET(ClpvSweepHalo, side)                  \
    OFFSET(ClpvSweepHalo, layers)                                                                 \
  SIZE(ClpvRegion) OFFSET(ClpvRegion, base) OFFSET(ClpvRegion, cell) OFFSET(ClpvRegion, first)     \
    OFFSET(ClpvRegion, boxes) OFFSET(ClpvRegion, moved) OFFSET(ClpvRegion, all)                    \
    OFFSET(ClpvRegion, box)
// clang-format on
