// Every choice that shapes a rendered frame, with its default.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace clpv {

enum class RsmFormat { float32, paper };  ///< paper: 32-bit depth, 8-bit normal and flux
enum class ToneMap { none, reinhard, aces };

struct RenderOptions {
  std::string basis = "sh2";
  double lambda = 0.25;
  std::string transport = "sampled";
  int iterations = 8;
  int grid = 32;               ///< cells along each axis of a cascade
  int cascades = 3;
  double cascade_size = 12.5;  ///< edge of the finest cascade [m]; each next one twice that
  int rsm_size = 256;          ///< texels along each side
  int shadow_size = 1024;      ///< texels along each side of a light's shadow map
  RsmFormat rsm_format = RsmFormat::float32;
  bool occlusion = true;       ///< indirect shadows: the geometry volume blocks
  int width = 960, height = 540;
};

}  // namespace clpv
