// SPDX-License-Identifier: MIT
#include "pipeline/raster/surface.hpp"

#include <algorithm>
#include <cmath>

#include "support/error.hpp"

namespace clpv {
namespace {

using Bytes = std::vector<cl_uchar4>;

std::size_t pixels(const ClpvView& view) {
  return static_cast<std::size_t>(view.width) * view.height;
}

std::size_t texel_bytes(RsmFormat format) {
  return format == RsmFormat::paper ? sizeof(cl_uchar4) : sizeof(cl_float4);
}

cl_uchar to_byte(float value) {  // rounds like convert_uchar_sat_rte
  return static_cast<cl_uchar>(std::nearbyint(std::clamp(value * 255.0f, 0.0f, 255.0f)));
}

/// `scale` x stored / 255 + `offset`
std::vector<glm::vec4> decode(const Bytes& stored, float scale, float offset) {
  std::vector<glm::vec4> values;
  values.reserve(stored.size());
  for (const cl_uchar4& s : stored) {
    values.emplace_back(glm::vec3(s.s[0], s.s[1], s.s[2]) * (scale / 255.0f) + offset, 0.0f);
  }
  return values;
}

Bytes encode(const std::vector<glm::vec4>& values, float scale, float offset) {
  Bytes stored;
  stored.reserve(values.size());
  for (const glm::vec4& v : values) {
    stored.push_back({{to_byte((v.x - offset) / scale), to_byte((v.y - offset) / scale),
                       to_byte((v.z - offset) / scale), 255}});
  }
  return stored;
}

std::vector<glm::vec4> read_texels(Session& session, const Buffer& buffer, std::size_t count,
                                   std::size_t first, RsmFormat format, float scale, float offset) {
  if (format == RsmFormat::paper)
    return decode(session.read<cl_uchar4>(buffer, count, first), scale, offset);
  return session.read<glm::vec4>(buffer, count, first);
}

void write_texels(Session& session, const Buffer& buffer, const std::vector<glm::vec4>& values,
                  RsmFormat format, float scale, float offset) {
  if (format == RsmFormat::paper) {
    session.write(buffer, encode(values, scale, offset));
  } else {
    session.write(buffer, values);
  }
}

void require_size(std::size_t found, std::size_t wanted, const char* what) {
  if (found != 0 && found != wanted) {
    throw Error(ExitCode::run_time, "surface: {} values of {} for {} pixels", found, what, wanted);
  }
}

}  // namespace

Surface make_surface(Session& session, const ClpvView& view, RsmFormat format, bool with_emissive,
                     int surfaces) {
  Surface surface;
  surface.view = view;
  surface.format = format;
  const std::size_t count = surfaces * pixels(view);
  surface.depth = session.buffer(count * sizeof(float), "depth of a surface");
  surface.normal = session.buffer(count * texel_bytes(format), "normals of a surface");
  surface.colour = session.buffer(count * texel_bytes(format), "colours of a surface");
  if (with_emissive)
    surface.emissive = session.buffer(count * sizeof(cl_float4), "emission of a surface");
  return surface;
}

SurfaceImage read_surface(Session& session, const Surface& surface) {
  const std::size_t count = pixels(surface.view);
  SurfaceImage image;
  image.view = surface.view;
  image.normal = read_texels(session, surface.normal, count, surface.first, surface.format, 2, -1);
  image.colour = read_texels(session, surface.colour, count, surface.first, surface.format,
                             surface.colour_scale, 0);
  if (surface.position.exists()) {
    image.position = session.read<glm::vec4>(surface.position, count);
    return image;
  }
  image.depth = session.read<float>(surface.depth, count, surface.first);
  if (surface.emissive.exists()) image.emissive = session.read<glm::vec4>(surface.emissive, count);
  for (std::size_t i = 0; i < count; ++i) {
    glm::vec4& normal = image.normal[i];
    if (image.depth[i] == 0) {
      normal = glm::vec4(0);
    } else if (surface.format == RsmFormat::paper) {
      normal = glm::vec4(glm::normalize(glm::vec3(normal)), 0);  // 8-bit storage changes its length
    }
  }
  return image;
}

Surface upload_surface(Session& session, const SurfaceImage& image, RsmFormat format,
                       float colour_scale) {
  const std::size_t count = pixels(image.view);
  require_size(image.depth.size(), count, "depth");
  require_size(image.normal.size(), count, "normals");
  require_size(image.colour.size(), count, "colours");
  require_size(image.emissive.size(), count, "emission");
  require_size(image.position.size(), count, "positions");
  Surface surface = make_surface(session, image.view, format, !image.emissive.empty());
  if (!image.position.empty())
    surface.position = session.upload(image.position, "positions of a surface");
  surface.colour_scale = colour_scale;
  session.write(surface.depth, image.depth);
  write_texels(session, surface.normal, image.normal, format, 2, -1);
  write_texels(session, surface.colour, image.colour, format, colour_scale, 0);
  if (!image.emissive.empty()) session.write(surface.emissive, image.emissive);
  return surface;
}

}  // namespace clpv
