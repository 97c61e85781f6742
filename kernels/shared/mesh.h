// SPDX-License-Identifier: MIT
// Triangles, materials and textures of the scene, shared by host and kernels. World space, metres.
#pragma once

#define CLPV_NO_TEXTURE 0xffffffffu

enum {
  CLPV_WRAP_REPEAT,
  CLPV_WRAP_CLAMP,
  CLPV_WRAP_MIRROR,
};

// Bits of ClpvMaterial::flags. Holes: texels with alpha below alpha_cutoff. Double sided: visible
// from both sides; the normal is flipped towards the viewer.
#define CLPV_MATERIAL_MASKED 1u
#define CLPV_MATERIAL_DOUBLE_SIDED 2u

typedef struct {
  float position[3];  // [m]
  float normal[3];    // unit
  float uv[2];        // base-colour texture, its KHR_texture_transform applied
  float colour[4];    // vertex colour, linear; 1 where the model has none
} ClpvVertex;

typedef struct {
  unsigned int vertex[3];
  unsigned int material;
} ClpvTriangle;

typedef struct {
  float base_colour[4];  // linear albedo and alpha; multiplied by texture and vertex colour
  float emissive[3];     // radiance [W/m^2/sr] of the front, and of the back where double sided
  float alpha_cutoff;
  unsigned int texture;           // index, or CLPV_NO_TEXTURE
  unsigned int emissive_texture;  // index, or CLPV_NO_TEXTURE; same uv
  unsigned int flags;             // CLPV_MATERIAL_*
  unsigned int unused;
} ClpvMaterial;

// Rows of four floats of these structs, for kernels that gather a row per lane.
enum {
  CLPV_VERTEX_POSITION,  // and x of the normal
  CLPV_VERTEX_UV,        // after y and z of the normal
  CLPV_VERTEX_COLOUR,
  CLPV_VERTEX_ROWS,
  CLPV_MATERIAL_COLOUR = 0,
  CLPV_MATERIAL_EMISSIVE,  // and alpha_cutoff
  CLPV_MATERIAL_TEXTURES,  // texture, emissive_texture, flags
  CLPV_MATERIAL_ROWS,
};

// Mip levels of every texture in the table; the level of 1 x 1 texels repeats. Level l of texture t
// is entry t * CLPV_TEXTURE_LEVELS + l. The maximum side is 2^(CLPV_TEXTURE_LEVELS - 1).
enum { CLPV_TEXTURE_LEVELS = 16 };

typedef struct {
  unsigned int offset;  // start of the level in the texel buffer: 4 bytes per texel, RGB in sRGB
                        // encoding, linear alpha; in blocks of 4 x 4, which share a cache line
  unsigned int width, height;
  unsigned int wrap;  // CLPV_WRAP_* of u, plus 16 times that of v
} ClpvTexture;

