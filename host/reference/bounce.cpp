// SPDX-License-Identifier: MIT
// One bounce: Phi_a = R_a sum_b Omega_b max(0, -w_b . n_a) L_b s^2, emitted by the cosine about a;
// n_a: normal of the face's triangles.
// All bounces without a medium: light = I + R D_1 + S (D_2 - D_1) in every cascade, coarsest first;
// with three sweeps and more, the second starts from I + E D.
#include "reference/bounce.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>

#include "basis/bounce.hpp"
#include "basis/sweep.hpp"
#include "kernels/shared/reflectors.h"
#include "reference/medium.hpp"

namespace clpv::reference {
namespace {

/// Flux [W] on, or off, the six faces of a cell, in a channel.
using FaceFlux = std::function<std::vector<double>(int, const glm::ivec3&)>;

/// Adds the intensity of the flux that leaves faces to `light`. `reflectors`: shares of the faces'
/// triangles.
void inject_flux(const Basis& basis, const FaceFlux& leaving, const Volume& reflectors,
                 Volume& light) {
  const Matrix intensity = reflected_intensity(basis);
  for_each_cell(light.n, [&](const glm::ivec3& p) {
    const std::vector<double> shares = reflectors.cell(CLPV_REFLECTOR_SHARE, p);
    for (int channel = 0; channel < 3; ++channel) {
      const std::vector<double> fluxes = leaving(channel, p);
      for (int side = 0; side < kCellFaces; ++side) {
        const double flux = fluxes[side];
        const double per_share =
            basis.bands() > 0 ? flux / std::max(shares[side], kLeastShare) : flux;
        for (int i = 0; i < basis.size(); ++i)
          light.at(channel, i, p.x, p.y, p.z) += intensity(i, side) * (i == 0 ? flux : per_share);
      }
    }
  });
}

/// Light of faces that emit `flux` [W].
Volume emitted(const Basis& basis, const Volume& flux, const Volume& reflectors) {
  Volume light(flux.n, basis.size());
  inject_flux(
      basis, [&](int channel, const glm::ivec3& p) { return flux.cell(channel, p); }, reflectors,
      light);
  return light;
}

/// Normal of the triangles of a face (kernels/sweep/bounce.cl). `share`, `area`: of all faces.
glm::dvec3 face_normal(const std::vector<double>& share, const std::vector<double>& area,
                       int face) {
  const auto tilt = [&](int side) {
    const double t = share[side] > 0 ? 1 / share[side] - 1 : 0;
    return t > double{CLPV_LEAST_TILT} ? t : 0;
  };
  const int axis = face / 2;
  const double t = tilt(face);
  glm::dvec3 along(0), v(0);
  along[axis] = face % 2 == 0 ? 1 : -1;
  if (t == 0) return along;
  for (int side = 0; side < kCellFaces; ++side)
    v[side / 2] += (side % 2 == 0 ? 1 : -1) * area[side] * std::min(tilt(side) / t, 1.0);
  v[axis] = std::max(area[face], 1e-6) * along[axis];
  v = glm::normalize(v);
  const double sides = std::abs(v.x) + std::abs(v.y) + std::abs(v.z) - 1,
               part = t < sides ? t / sides : 1;
  return glm::normalize((1 - part) * along + part * v);
}

/// Incident flux of swept light about the normals of the faces' triangles.
FaceFlux incident_flux_of(const Volume& swept, const Volume& reflectors) {
  return [flux = incident_flux(), &swept, &reflectors](int channel, const glm::ivec3& p) {
    const std::vector<double> bins = swept.cell(channel, p),
                              share = reflectors.cell(CLPV_REFLECTOR_SHARE, p),
                              area = reflectors.cell(CLPV_REFLECTOR_AREA, p);
    std::vector<double> incident(kCellFaces);
    for (int side = 0; side < kCellFaces; ++side) {
      const glm::dvec3 n = face_normal(share, area, side);
      for (std::size_t b = 0; b < bins.size(); ++b) {
        double weight = 0;
        for (int axis = 0; axis < 3; ++axis)
          weight += n[axis] * (flux(2 * axis, b) - flux(2 * axis + 1, b));
        incident[side] += std::max(weight, 0.0) * bins[b];
      }
    }
    return incident;
  };
}

/// `reflectance` times the incident flux of swept light.
FaceFlux reflected_flux(const Volume& reflectance, const Volume& swept, const Volume& reflectors) {
  return [&, incident = incident_flux_of(swept, reflectors)](int channel, const glm::ivec3& p) {
    std::vector<double> flux = incident(channel, p);
    for (int side = 0; side < kCellFaces; ++side)
      flux[side] *= reflectance.value(channel, side, p.x, p.y, p.z);
    return flux;
  };
}

/// light += R D in every cascade.
void add_one_bounce(const Basis& basis, const Transport& transport,
                    const std::vector<SweptCascade>& cascades,
                    const std::vector<const Volume*>& reflectors, std::vector<Volume>& light) {
  const std::vector<Volume> swept = sweep(basis, transport, cascades);
  for (std::size_t c = 0; c < cascades.size(); ++c)
    inject_flux(basis, reflected_flux(*reflectors[c], swept[c], *reflectors[c]), *reflectors[c],
                light[c]);
}

/// light += R D_1 + S (D_2 - D_1), not below 0, in every cascade; D_2 is of the last sweep for
/// incident flux, D_1 of the one before. The coarser cascade's last sweep enters at the border.
void add_all_bounces(const Basis& basis, const Transport& transport,
                     const std::vector<SweptCascade>& cascades,
                     const std::vector<const Volume*>& reflectors, int sweeps,
                     std::vector<Volume>& light) {
  for (std::size_t c = cascades.size(); c-- > 0;) {
    const std::vector<SweptCascade> nested(cascades.begin() + static_cast<std::ptrdiff_t>(c),
                                           cascades.end());
    const Volume injected = light[c];
    const BounceSeries series = bounce_series(basis, transport, cascades[c], *reflectors[c]);
    Volume before, after = sweep(basis, transport, nested)[0];
    for (int done = 1; done < sweeps; ++done) {
      before = after, light[c] = injected;
      const bool relaxed = done == 1 && sweeps > kLeastSeriesSweeps;
      inject_flux(basis,
                  reflected_flux(relaxed ? series.first : *reflectors[c], before, *reflectors[c]),
                  *reflectors[c], light[c]);
      after = sweep(basis, transport, nested)[0];
    }
    light[c] = injected;
    const FaceFlux known = reflected_flux(*reflectors[c], before, *reflectors[c]),
                   earlier = reflected_flux(series.all, before, *reflectors[c]),
                   later = reflected_flux(series.all, after, *reflectors[c]);
    inject_flux(
        basis,
        [&](int channel, const glm::ivec3& p) {
          std::vector<double> flux = known(channel, p);
          const std::vector<double> first = earlier(channel, p), second = later(channel, p);
          for (std::size_t i = 0; i < flux.size(); ++i)
            flux[i] = std::max(flux[i] + second[i] - first[i], 0.0);
          return flux;
        },
        *reflectors[c], light[c]);
  }
}

/// Light that sweeps start from, by cascade.
struct Sources {
  std::vector<Volume> light, scattered;

  /// Cascades from `first` on with these sources.
  std::vector<SweptCascade> of(std::vector<SweptCascade> cascades, std::size_t first) const {
    for (std::size_t c = 0; c < cascades.size(); ++c)
      cascades[c].injected = &light[c], cascades[c].scattered = &scattered[c];
    return {cascades.begin() + static_cast<std::ptrdiff_t>(first), cascades.end()};
  }
};

/// Bounces off surfaces and in a medium: each of `sweeps` sweeps is reflected
/// and scattered. A cascade's border has light of the coarser one's last sweep.
Sources bounce_in_medium(const Basis& basis, const Transport& transport,
                         const std::vector<SweptCascade>& cascades,
                         const std::vector<const Volume*>& reflectors, int sweeps) {
  Sources swept;  // sources of the last sweep
  for (const SweptCascade& cascade : cascades) {
    swept.light.push_back(*cascade.injected);
    swept.scattered.push_back(*cascade.scattered);
  }
  Sources result = swept;
  for (std::size_t c = cascades.size(); c-- > 0;) {
    for (int i = 0; i < sweeps; ++i) {
      swept.light[c] = result.light[c], swept.scattered[c] = result.scattered[c];
      const Volume found = sweep(basis, transport, swept.of(cascades, c))[0];
      result.light[c] = *cascades[c].injected;
      inject_flux(basis, reflected_flux(*reflectors[c], found, *reflectors[c]), *reflectors[c],
                  result.light[c]);
      result.scattered[c] = *cascades[c].scattered;
      add_scattered(*cascades[c].medium, found, result.scattered[c]);
    }
  }
  return result;
}

}  // namespace

BounceSeries bounce_series(const Basis& basis, const Transport& transport,
                           const SweptCascade& cascade, const Volume& reflectors) {
  // R X, X the incident flux while each face emits `flux`.
  const auto returned = [&](const Volume& flux) {
    const Volume light = emitted(basis, flux, reflectors);
    SweptCascade emitting = cascade;
    emitting.injected = &light;
    const Volume swept = sweep(basis, transport, {emitting})[0];
    const FaceFlux leaving = reflected_flux(reflectors, swept, reflectors);
    Volume reflected = reflectors;
    for_each_cell(flux.n, [&](const glm::ivec3& p) {
      for (int channel = 0; channel < 3; ++channel)
        reflected.set_cell(channel, p, leaving(channel, p));
    });
    return reflected;
  };
  const Volume first = returned(reflectors), second = returned(first);
  BounceSeries series{reflectors, reflectors};
  for_each_cell(reflectors.n, [&](const glm::ivec3& p) {
    for (int channel = 0; channel < 3; ++channel) {
      double bound = 0;
      for (int side = 0; side < kCellFaces; ++side)
        bound = std::max(
            bound, reflectors.value(channel, side, p.x, p.y, p.z) /
                       std::max(reflectors.value(CLPV_REFLECTOR_WHITE, side, p.x, p.y, p.z), 1e-6));
      bound = std::min(bound, kMaxReturned);
      for (int side = 0; side < kCellFaces; ++side) {
        const double t1 = first.value(channel, side, p.x, p.y, p.z),
                     t2 = second.value(channel, side, p.x, p.y, p.z),
                     ratio = std::clamp(t2 / std::max(t1, 1e-6), 0.0, bound);
        series.all.at(channel, side, p.x, p.y, p.z) += t1 + t2 / (1 - ratio);
        series.first.at(channel, side, p.x, p.y, p.z) /= 1 - kRelaxation * ratio;
      }
    }
  });
  return series;
}

std::vector<Volume> furnace(const Basis& basis, const Transport& transport,
                            std::vector<SweptCascade> cascades,
                            const std::vector<const Volume*>& white, double most_white) {
  Sky even;
  even.width = even.height = 1, even.texels = {glm::vec3(1)};
  std::vector<Volume> light;
  const auto area = [&](std::size_t c) { return std::pow(double{cascades[c].grid.cell}, 2); };
  for (std::size_t c = 0; c < cascades.size(); ++c) {
    Volume flux(white[c]->n, kCellFaces);
    for_each_cell(flux.n, [&](const glm::ivec3& p) {
      std::vector<double> covered = white[c]->cell(CLPV_REFLECTOR_WHITE, p);
      for (double& each : covered) each *= std::numbers::pi * area(c);
      for (int channel = 0; channel < 3; ++channel) flux.set_cell(channel, p, covered);
    });
    light.push_back(emitted(basis, flux, *white[c]));
  }
  for (std::size_t c = 0; c < cascades.size(); ++c) {
    cascades[c].injected = &light[c];
    cascades[c].medium = nullptr, cascades[c].scattered = nullptr;
  }
  std::vector<Volume> swept = sweep(basis, transport, cascades, &even);
  for (std::size_t c = 0; c < cascades.size(); ++c) {
    const Volume surfaces = sweep(basis, transport, {cascades[c]})[0];
    for (std::size_t i = 0; i < surfaces.values.size(); ++i) {
      const double closed = surfaces.values[i] / area(c),
                   border = swept[c].values[i] / area(c) - closed;
      const double open = std::min(border, 2 * std::max(0.0, border - kLeastOpen));
      swept[c].values[i] = std::min(most_white, closed + open);
    }
  }
  return swept;
}

std::vector<Volume> normalised_reflectors(const Basis& basis, const Transport& transport,
                                          const std::vector<SweptCascade>& cascades,
                                          const std::vector<const Volume*>& white,
                                          const std::vector<const Volume*>& reflectors,
                                          Bounces bounces, double most_white) {
  std::vector<Volume> normalised;
  for (std::size_t c = 0; c < cascades.size(); ++c) {
    const auto first = static_cast<std::ptrdiff_t>(c);
    const std::vector<SweptCascade> nested(cascades.begin() + first, cascades.end());
    const bool all = bounces == Bounces::all && cascades[c].scattered == nullptr;
    std::vector<const Volume*> emitting(white.begin() + first, white.end());
    for (std::size_t i = 0; i < nested.size() && (i == 0 || !all); ++i)
      emitting[i] = reflectors[c + i];
    const Volume even = furnace(basis, transport, nested, emitting, most_white)[0];
    const FaceFlux incident = incident_flux_of(even, *reflectors[c]);
    Volume& result = normalised.emplace_back(*reflectors[c]);
    for_each_cell(result.n, [&](const glm::ivec3& p) {
      const std::vector<double> arriving = incident(0, p);
      for (const int channel : {0, 1, 2, int{CLPV_REFLECTOR_WHITE}})
        for (int side = 0; side < kCellFaces; ++side)
          result.at(channel, side, p.x, p.y, p.z) /=
              over_furnace(arriving[side] / std::numbers::pi);
    });
  }
  return normalised;
}

std::vector<Volume> bounce(const Basis& basis, const Transport& transport,
                           std::vector<SweptCascade> cascades,
                           const std::vector<const Volume*>& reflectors, Bounces bounces,
                           int sweeps) {
  std::vector<Volume> light;
  for (const SweptCascade& cascade : cascades) light.push_back(*cascade.injected);
  for (std::size_t c = 0; c < cascades.size(); ++c) cascades[c].injected = &light[c];
  if (bounces == Bounces::two) add_one_bounce(basis, transport, cascades, reflectors, light);
  if (bounces == Bounces::all)
    add_all_bounces(basis, transport, cascades, reflectors, sweeps, light);
  return light;
}

std::vector<Volume> sweep_bounced(const Basis& basis, const Transport& transport,
                                  std::vector<SweptCascade> cascades,
                                  const std::vector<const Volume*>& reflectors, Bounces bounces,
                                  int sweeps) {
  if (cascades.front().scattered != nullptr) {
    const Sources sources = bounce_in_medium(basis, transport, cascades, reflectors,
                                             bounces == Bounces::all ? kScatteredSweeps : 1);
    return sweep(basis, transport, sources.of(cascades, 0));
  }
  const std::vector<Volume> light = bounce(basis, transport, cascades, reflectors, bounces, sweeps);
  for (std::size_t c = 0; c < cascades.size(); ++c) cascades[c].injected = &light[c];
  return sweep(basis, transport, cascades);
}

}  // namespace clpv::reference
