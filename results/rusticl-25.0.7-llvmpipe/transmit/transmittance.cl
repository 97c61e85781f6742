// SPDX-License-Identifier: MIT
typedef float realW, Coefficient;
typedef struct { Coefficient c[3]; } Coefficients;
static inline __attribute__((always_inline)) float read_number(__global const float* from, const int at) {
return from[at];
}
static inline __attribute__((always_inline)) void write_number(__global float* to, const int at, const float value) {
to[at] = value;
}
static inline __attribute__((always_inline)) int geometry_address(const int channel, const int x, const int y, const int z) {
return channel * (3 * ((((7 + 1) + 7) / 8 * 8 + 2) * ((7 + 1) + 2) * ((7 + 1) + 2))) + ((z + 1) * ((7 + 1) + 2) + (y + 1)) * (((7 + 1) + 7) / 8 * 8 + 2) + (x + 1);
}
static inline __attribute__((always_inline)) Coefficients geometry_load(__global const float* volume, const int channel, const int x, const int y, const int z) {
const int at = geometry_address(channel, x, y, z);
Coefficients cell;
for (int i = 0; i < 3; ++i) cell.c[i] = read_number(volume, at + i * ((((7 + 1) + 7) / 8 * 8 + 2) * ((7 + 1) + 2) * ((7 + 1) + 2)));
return cell;
}
typedef struct { realW c[30]; } Links;
__constant const int link_sides[3 * 30] = {1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 1, 0, 1, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, -1, 0, -1, 0, 1, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 1, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, -1, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0};
__constant const float link_blocked[30][3] = {{0.25f, 0.0f, 0.0f}, {0.223606795f, 0.111803398f, 0.0f}, {0.223606795f, 0.111803398f, 0.0f}, {0.223606795f, 0.0f, 0.111803398f}, {0.223606795f, 0.0f, 0.111803398f}, {0.25f, 0.0f, 0.0f}, {0.223606795f, 0.111803398f, 0.0f}, {0.223606795f, 0.111803398f, 0.0f}, {0.223606795f, 0.0f, 0.111803398f}, {0.223606795f, 0.0f, 0.111803398f}, {0.0f, 0.25f, 0.0f}, {0.111803398f, 0.223606795f, 0.0f}, {0.111803398f, 0.223606795f, 0.0f}, {0.0f, 0.223606795f, 0.111803398f}, {0.0f, 0.223606795f, 0.111803398f}, {0.0f, 0.25f, 0.0f}, {0.111803398f, 0.223606795f, 0.0f}, {0.111803398f, 0.223606795f, 0.0f}, {0.0f, 0.223606795f, 0.111803398f}, {0.0f, 0.223606795f, 0.111803398f}, {0.0f, 0.0f, 0.25f}, {0.111803398f, 0.0f, 0.223606795f}, {0.111803398f, 0.0f, 0.223606795f}, {0.0f, 0.111803398f, 0.223606795f}, {0.0f, 0.111803398f, 0.223606795f}, {0.0f, 0.0f, 0.25f}, {0.111803398f, 0.0f, 0.223606795f}, {0.111803398f, 0.0f, 0.223606795f}, {0.0f, 0.111803398f, 0.223606795f}, {0.0f, 0.111803398f, 0.223606795f}};
static inline __attribute__((always_inline)) realW pick_side(const int side, const realW lower, const realW upper) {
return side < 0 ? lower : (side > 0 ? upper : lower + upper);
}
static inline __attribute__((always_inline)) realW sum_corners(const Coefficients* corners, const int link, const int i) {
realW edges[4];
#pragma unroll
for (int e = 0; e < 4; ++e) edges[e] = pick_side(link_sides[3 * link], corners[2 * e].c[i], corners[2 * e + 1].c[i]);
return pick_side(link_sides[3 * link + 2], pick_side(link_sides[3 * link + 1], edges[0], edges[1]), pick_side(link_sides[3 * link + 1], edges[2], edges[3]));
}
static inline __attribute__((always_inline)) Links find_transmittance(__global const float* blockers, const int x, const int y, const int z) {
Coefficients corners[8];
#pragma unroll
for (int c = 0; c < 8; ++c) corners[c] = geometry_load(blockers, 0, x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
Links links;
#pragma unroll
for (int link = 0; link < 30; ++link) {
realW blocked = 0.0f;
#pragma unroll
for (int i = 0; i < 3; ++i) if (link_blocked[link][i] != 0.0f) blocked = fma((realW)(link_blocked[link][i]), sum_corners(corners, link, i), blocked);
const realW share = blocked > ((realW)(0.0f)) ? blocked : ((realW)(0.0f));
links.c[link] = ((realW)(1.0f)) - (share < ((realW)(1.0f)) ? share : ((realW)(1.0f)));
}
return links;
}
static inline __attribute__((always_inline)) int transmittance_address(const int channel, const int x, const int y, const int z) {
return channel * (30 * (((7 + 7) / 8 * 8 + 2) * (7 + 2) * (7 + 2))) + ((z + 1) * (7 + 2) + (y + 1)) * ((7 + 7) / 8 * 8 + 2) + (x + 1);
}
static inline __attribute__((always_inline)) void transmittance_store(__global float* volume, const int channel, const int x, const int y, const int z, const Links cell) {
const int at = transmittance_address(channel, x, y, z);
#pragma unroll
for (int i = 0; i < 30; ++i) write_number(volume, at + i * (((7 + 7) / 8 * 8 + 2) * (7 + 2) * (7 + 2)), cell.c[i]);
}
__kernel __attribute__((reqd_work_group_size(7, 1, 1))) void transmit( __global const float* blockers, __global float* transmittance) {
const int x = 1 * (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
transmittance_store(transmittance, 0, x, y, z, find_transmittance(blockers, x, y, z));
}
