// SPDX-License-Identifier: MIT
// Suite `probes`: a look-up of light probes on the device, by format (docs/bake.md).
#include "bake/probe_formats.hpp"
#include "bake/probe_grid.hpp"
#include "basis/basis.hpp"
#include "basis/sampling.hpp"
#include "bench/suites.hpp"
#include "device/kernel.hpp"
#include "support/error.hpp"
#include "verify/comparison.hpp"
#include "volume/volume_format.hpp"

namespace clpv::bench {
namespace {

constexpr int kSide = 16;   // probes along each axis
constexpr int kLights = 3;  // distant lights of each probe
constexpr std::size_t kLocal = 64;
constexpr double kAllowed = 1e-4;  // of the largest irradiance: float, and pow of two floats

/// How the kernel looks up a format: CLPV_PROBE, the basis of its functions, and how many numbers
/// it reads; 0: all.
struct LookUp {
  const char *format, *kind, *basis;
  std::size_t read = 0;
};
constexpr LookUp kLookUps[] = {{"sh2-geomerics", "GEOMERICS", "sh2"},
                               {"zh3-hallucinated", "GUESSED", "sh2"},
                               {"zh3", "ZONAL", "sh2"},
                               {"ambient-cube", "CUBE", "sh2", 3},
                               {"ambient-cube-mean", "CUBE", "sh2", 3},
                               {"sh3-windowed", "BASIS", "sh3"},
                               {"dice", "DICE", "sh2", 3},
                               {"dice-srbf", "LOBES", "sh2"}};

/// Others are sums of their basis's functions.
LookUp look_up_of(const std::string& format) {
  for (const LookUp& each : kLookUps)
    if (each.format == format) return each;
  return {format.c_str(), "BASIS", format.c_str()};
}

struct Scene {
  bake::ProbeGrid grid{glm::ivec3(kSide), glm::dvec3(0), glm::dvec3(kSide - 1)};
  std::vector<glm::vec3> coefficients;
  std::vector<glm::vec3> points;  ///< position [spacings], normal
};

Scene scene_of(const bake::ProbeFormat& format, std::size_t count) {
  Scene scene;
  Random random{1};
  std::vector<double> g(format.moments.count);
  for (std::size_t probe = 0; probe < scene.grid.size(); ++probe) {
    std::vector<glm::dvec3> integrals(g.size(), glm::dvec3(0));
    for (int light = 0; light < kLights; ++light) {
      const glm::dvec3 colour(random.next(), random.next(), random.next());
      format.moments.weights(random.direction(), g);
      for (std::size_t i = 0; i < g.size(); ++i) integrals[i] += g[i] * colour;
    }
    for (const glm::dvec3& c : format.encoded(integrals)) scene.coefficients.emplace_back(c);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 share(random.next(), random.next(), random.next());
    scene.points.emplace_back(glm::min(share * (kSide - 1.0), kSide - 1.001));
    scene.points.emplace_back(random.direction());
  }
  return scene;
}

Deviation deviation_of(const bake::ProbeFormat& format, const Scene& scene,
                       const std::vector<float>& found) {
  std::vector<double> wanted;
  for (std::size_t i = 0; 2 * i < scene.points.size(); i += kCheckedPixels) {
    const glm::dvec3 at(scene.points[2 * i]), n(scene.points[2 * i + 1]);
    const glm::dvec3 e =
        format.irradiance(bake::interpolated(scene.grid, scene.coefficients, format.size, at), n);
    wanted.insert(wanted.end(), {e.x, e.y, e.z});
  }
  const auto value = [&](std::size_t i) { return found[3 * kCheckedPixels * (i / 3) + i % 3]; };
  const verify::WorstError worst =
      verify::worst_difference(wanted.size(), value, [&](std::size_t i) { return wanted[i]; });
  return {worst.value, kAllowed,
          fmt::format("{}, point {}: {}, expected {}", format.name, worst.at / 3 * kCheckedPixels,
                      value(worst.at), wanted[worst.at])};
}

Job probe_job(Session& session, const bake::ProbeFormat& format, std::size_t count) {
  const LookUp look = look_up_of(format.name);
  const auto scene = std::make_shared<const Scene>(scene_of(format, count));
  const std::unique_ptr<const Basis> basis = make_basis(look.basis);
  const std::size_t read = look.read > 0 ? look.read : format.size;
  ProgramSource source{"probes.cl"};
  source.literals.word("CLPV_PROBE", fmt::format("CLPV_PROBE_{}", look.kind))
      .integer("CLPV_STORED", format.size)
      .integer("CLPV_READ", read);
  add_coefficient_literals(source.literals, basis->size(), "float");
  basis->add_literals(source.literals);
  const auto kernel = std::make_shared<Kernel>(session, source, "look_up_probes");
  const Buffer probes = session.upload(scene->coefficients, "probes"),
               points = session.upload(scene->points, "probes, points"),
               light = session.buffer(count * 3 * sizeof(float), "probes, light");
  Job job;
  job.reset = [&session, light, count] { session.fill_zero(light, count * 3 * sizeof(float)); };
  job.run = [=] {
    kernel->set(static_cast<cl_int>(count), kSide, probes, points, light)
        .launch((count + kLocal - 1) / kLocal * kLocal, kLocal);
  };
  job.compare = [&session, scene, format, light, count] {
    return deviation_of(format, *scene, session.read<float>(light, count * 3));
  };
  job.cost.pixels = static_cast<double>(count);
  return job;
}

}  // namespace

Suite probes_suite() {
  return {"probes",
          "a look-up of light probes by format, at as many random points as pixels",
          [](Session& session, const SuiteOptions& options) {
            const auto count = static_cast<std::size_t>(options.settings.width) *
                               static_cast<std::size_t>(options.settings.height);
            std::vector<Case> cases;
            for (const std::string& name : bake::probe_format_names()) {
              Case one;
              one.row.suite = "probes", one.row.stage = "probe", one.row.name = "probe/" + name;
              one.make = [&session, name, count] {
                return probe_job(session, bake::probe_format(name), count);
              };
              cases.push_back(std::move(one));
            }
            return std::vector<Group>{{[cases] { return cases; }}};
          },
          {}};
}

}  // namespace clpv::bench
