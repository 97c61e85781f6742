// SPDX-License-Identifier: MIT
// List of the structs that host and kernels share, with the members whose offsets must agree
// (sizes.cl).
//
// CLPV_EACH_SHARED(FIELD) writes FIELD(type, member) in a fixed order. Include the headers of the
// structs before: host and kernels name them by different paths.
#pragma once

// clang-format off
#define CLPV_EACH_SHARED(FIELD)                                                                    \
  FIELD(ClpvGrid, origin) FIELD(ClpvGrid, cell) FIELD(ClpvGrid, n) FIELD(ClpvGrid, middle)         \
  FIELD(ClpvLight, position) FIELD(ClpvLight, kind) FIELD(ClpvLight, direction)                    \
    FIELD(ClpvLight, range) FIELD(ClpvLight, intensity) FIELD(ClpvLight, cone_scale)               \
    FIELD(ClpvLight, cone_offset) FIELD(ClpvLight, narrow_cone) FIELD(ClpvLight, medium)           \
  FIELD(ClpvMedium, lower) FIELD(ClpvMedium, upper) FIELD(ClpvMedium, scattering)                  \
    FIELD(ClpvMedium, extinction) FIELD(ClpvMedium, anisotropy)                                    \
  FIELD(ClpvVertex, position) FIELD(ClpvVertex, normal) FIELD(ClpvVertex, uv)                      \
    FIELD(ClpvVertex, colour)                                                                      \
  FIELD(ClpvTriangle, vertex) FIELD(ClpvTriangle, material)                                        \
  FIELD(ClpvMaterial, base_colour) FIELD(ClpvMaterial, emissive)                                   \
    FIELD(ClpvMaterial, alpha_cutoff) FIELD(ClpvMaterial, texture)                                 \
    FIELD(ClpvMaterial, emissive_texture) FIELD(ClpvMaterial, flags)                               \
  FIELD(ClpvTexture, offset) FIELD(ClpvTexture, width) FIELD(ClpvTexture, height)                  \
    FIELD(ClpvTexture, wrap)                                                                       \
  FIELD(ClpvEmitter, triangle) FIELD(ClpvEmitter, u) FIELD(ClpvEmitter, v)                         \
    FIELD(ClpvEmitter, size) FIELD(ClpvEmitter, rows) FIELD(ClpvEmitter, first)                    \
    FIELD(ClpvEmitter, side)                                                                       \
  FIELD(ClpvInjection, view) FIELD(ClpvInjection, grid) FIELD(ClpvInjection, colour_scale)         \
    FIELD(ClpvInjection, first) FIELD(ClpvInjection, volume) FIELD(ClpvInjection, cascade)         \
  FIELD(ClpvView, eye) FIELD(ClpvView, orthographic) FIELD(ClpvView, right)                        \
    FIELD(ClpvView, half_width) FIELD(ClpvView, up) FIELD(ClpvView, half_height)                   \
    FIELD(ClpvView, forward) FIELD(ClpvView, near_depth) FIELD(ClpvView, width)                    \
    FIELD(ClpvView, height) FIELD(ClpvView, far_depth)                                             \
  FIELD(ClpvRasterTriangle, x) FIELD(ClpvRasterTriangle, y) FIELD(ClpvRasterTriangle, key)         \
    FIELD(ClpvRasterTriangle, key_x) FIELD(ClpvRasterTriangle, key_y)                              \
    FIELD(ClpvRasterTriangle, nearest) FIELD(ClpvRasterTriangle, farthest)                         \
    FIELD(ClpvRasterTriangle, first) FIELD(ClpvRasterTriangle, last)                               \
    FIELD(ClpvRasterTriangle, triangle)                                                            \
  FIELD(ClpvViewCluster, number) FIELD(ClpvViewCluster, view) FIELD(ClpvViewCluster, first)        \
    FIELD(ClpvViewCluster, last) FIELD(ClpvViewCluster, nearest)                                   \
  FIELD(ClpvWideTriangle, index) FIELD(ClpvWideTriangle, entry) FIELD(ClpvWideTriangle, view)      \
  FIELD(ClpvLitView, view) FIELD(ClpvLitView, light) FIELD(ClpvLitView, colour_scale)              \
    FIELD(ClpvLitView, first)                                                                      \
  FIELD(ClpvSweepBin, plane_sign) FIELD(ClpvSweepBin, row_sign) FIELD(ClpvSweepBin, column_sign)   \
    FIELD(ClpvSweepBin, plane_axis) FIELD(ClpvSweepBin, row_axis)                                  \
    FIELD(ClpvSweepBin, column_axis) FIELD(ClpvSweepBin, links) FIELD(ClpvSweepBin, transposed)    \
    FIELD(ClpvSweepBin, plane) FIELD(ClpvSweepBin, row)                                            \
  FIELD(ClpvSweepDirection, taps) FIELD(ClpvSweepDirection, share)                                 \
    FIELD(ClpvSweepDirection, from_coarser) FIELD(ClpvSweepDirection, coarser)                     \
    FIELD(ClpvSweepDirection, attenuation) FIELD(ClpvSweepDirection, cosine)                       \
  FIELD(ClpvSweepHalo, first) FIELD(ClpvSweepHalo, side) FIELD(ClpvSweepHalo, layers)              \
  FIELD(ClpvBox, low) FIELD(ClpvBox, high)                                                         \
  FIELD(ClpvRegion, base) FIELD(ClpvRegion, cell) FIELD(ClpvRegion, first)                         \
    FIELD(ClpvRegion, boxes) FIELD(ClpvRegion, moved) FIELD(ClpvRegion, all)                       \
    FIELD(ClpvRegion, box)
// clang-format on
