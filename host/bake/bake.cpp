// SPDX-License-Identifier: MIT
#include "bake/bake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <regex>

#include "parallel/ranks.hpp"
#include "pathtracer/threads.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/progress.hpp"

namespace clpv::bake {
namespace {

constexpr double kBacks = 0.25;  // share of all directions
constexpr std::size_t kHash = 16;
constexpr std::uint64_t kMaxOldBlocks = 1u << 30;  // bytes
constexpr std::chrono::hours kMaxAge(24 * 30);

void require_finite(const glm::vec3& light, const ProbeGrid& grid, std::size_t probe) {
  if (std::isfinite(light.x) && std::isfinite(light.y) && std::isfinite(light.z)) return;
  const glm::dvec3 at = grid.position(probe);
  throw Error(
      ExitCode::run_time,
      "probe at ({:.4g}, {:.4g}, {:.4g}): found light of {}, {}, {}, allowed: finite floats", at.x,
      at.y, at.z, light.x, light.y, light.z);
}

/// Mean of the neighbours that are known, weighted by the inverse square of their distance; false
/// without one.
bool fill(const ProbeGrid& grid, std::size_t probe, std::size_t n,
          const std::vector<std::uint8_t>& known, std::vector<glm::vec3>& coefficients) {
  const glm::ivec3 at = grid.at(probe);
  const glm::dvec3 spacing = grid.spacing();
  std::vector<glm::dvec3> sum(n, glm::dvec3(0));
  double weights = 0;
  for (int i = 0; i < 27; ++i) {
    const glm::ivec3 off(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1), place = at + off;
    if (off == glm::ivec3(0) || glm::any(glm::lessThan(place, glm::ivec3(0))) ||
        glm::any(glm::greaterThanEqual(place, grid.count)))
      continue;
    const std::size_t other = grid.index(place);
    if (!known[other]) continue;
    const glm::dvec3 apart = glm::dvec3(off) * spacing;
    const double weight = 1 / glm::dot(apart, apart);
    weights += weight;
    for (std::size_t k = 0; k < n; ++k) sum[k] += weight * glm::dvec3(coefficients[other * n + k]);
  }
  if (weights == 0) return false;
  for (std::size_t k = 0; k < n; ++k) coefficients[probe * n + k] = glm::vec3(sum[k] / weights);
  return true;
}

/// Calls action(i) for i below `count`, on threads (0: one per processor). Throws Interrupted.
void for_all(std::size_t count, int threads, const char* title,
             const std::function<void(std::size_t)>& action) {
  constexpr std::size_t kBatch = 256;
  Progress progress(title, count);
  std::atomic<std::size_t> next{0};
  pathtracer::on_threads(threads > 0 ? threads : single_rank().processors(),
                         [&, stop = current_stop()](const std::atomic<bool>& failed) {
                           const StopScope scope(stop);
                           for (std::size_t first; !failed && !interrupted() &&
                                                   (first = next.fetch_add(kBatch)) < count;) {
                             const std::size_t end = std::min(first + kBatch, count);
                             for (std::size_t i = first; i < end; ++i) action(i);
                             progress.advance(end - first);
                           }
                         });
  stop_if_interrupted();
}

/// Fills unknown probes from known ones, layer by layer.
void dilate_into(const ProbeGrid& grid, std::size_t n, std::vector<std::uint8_t> known,
                 std::vector<glm::vec3>& coefficients, int threads) {
  std::vector<std::size_t> unknown;
  for (std::size_t probe = 0; probe < grid.size(); ++probe)
    if (!known[probe]) unknown.push_back(probe);
  for (std::size_t before = 0; unknown.size() != before;) {
    before = unknown.size();
    std::vector<std::uint8_t> next = known;
    for_all(before, threads, "filling probes", [&](std::size_t i) {
      if (fill(grid, unknown[i], n, known, coefficients)) next[unknown[i]] = 1;
    });
    known = std::move(next);
    std::erase_if(unknown, [&](std::size_t probe) { return known[probe] != 0; });
  }
}

}  // namespace

BlockCache::BlockCache(const std::optional<std::filesystem::path>& folder, std::string key)
    : key_(std::move(key)) {
  if (!folder) return;
  folder_.emplace(*folder / "bakes");
  // Names of name_of(), and of the OutputFiles of killed processes.
  static const std::regex kOwn(R"([0-9a-z]+-\d+\.block|\.[0-9a-z]+-\d+\.block\.\d+-\d+\.part)");
  folder_->evict(kOwn, kMaxOldBlocks, kMaxAge);
}

std::string BlockCache::name_of(std::size_t block) const {
  return fmt::format("{}-{}.block", key_, block);
}

std::optional<BlockLight> BlockCache::read(std::size_t block, std::size_t numbers) const {
  if (!folder_) return std::nullopt;
  const std::size_t size = numbers * sizeof(glm::vec3);
  BlockLight light;
  const std::size_t head = kHash + sizeof light.noise + sizeof light.samples;
  const auto bytes = folder_->read(name_of(block), head + size);
  if (!bytes || bytes->size() != head + size) return std::nullopt;
  if (Fingerprint().add(std::string_view(*bytes).substr(kHash)).hex() != bytes->substr(0, kHash))
    return std::nullopt;  // damaged
  light.integrals.resize(numbers);
  const char* from = bytes->data() + kHash;
  std::memcpy(&light.noise, from, sizeof light.noise);
  std::memcpy(&light.samples, from + sizeof light.noise, sizeof light.samples);
  if (numbers > 0) std::memcpy(light.integrals.data(), bytes->data() + head, size);
  return light;
}

void BlockCache::write(std::size_t block, const BlockLight& light) {
  if (!folder_) return;
  std::string bytes;
  const auto add = [&](const void* from, std::size_t size) {
    bytes.append(static_cast<const char*>(from), size);
  };
  add(&light.noise, sizeof light.noise), add(&light.samples, sizeof light.samples);
  add(light.integrals.data(), light.integrals.size() * sizeof(glm::vec3));
  const std::string problem =
      folder_->write(name_of(block), Fingerprint().add(bytes).hex() + bytes);
  if (problem.empty()) return;
  log_warning("{}: an interrupted bake will begin again", problem);
  folder_.reset();
}

void BlockCache::clear(std::size_t count) {
  if (!folder_) return;
  for (std::size_t block = 0; block < count; ++block) {
    std::error_code ignored;
    std::filesystem::remove(folder_->path() / name_of(block), ignored);
  }
}

GridLight light_of(ProbeSource& source, const ProbeGrid& grid, std::size_t count, BlockCache& cache,
                   const std::function<void(std::size_t)>& done) {
  GridLight all;
  all.count = count;
  all.integrals.resize(grid.size() * count);
  double squares = 0;
  const auto& blocks = source.blocks();
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    stop_if_interrupted();
    std::optional<BlockLight> light = cache.read(block, blocks[block].size() * count);
    if (!light) {
      light = source.light(block);
      for (std::size_t i = 0; i < light->integrals.size(); ++i)
        require_finite(light->integrals[i], grid, blocks[block][i / count]);
      cache.write(block, *light);
    }
    for (std::size_t i = 0; i < blocks[block].size(); ++i)
      std::copy_n(light->integrals.begin() + static_cast<std::ptrdiff_t>(i * count), count,
                  all.integrals.begin() + static_cast<std::ptrdiff_t>(blocks[block][i] * count));
    all.samples = std::max(all.samples, light->samples);
    squares += double{light->noise} * double{light->noise} * double(blocks[block].size());
    done(block + 1);
  }
  all.noise = std::sqrt(squares / double(grid.size()));
  return all;
}

std::vector<std::uint8_t> validity(pathtracer::PointTracer& tracer,
                                   std::span<const glm::dvec3> positions) {
  std::vector<std::uint8_t> valid;
  for (const auto& [backs, open] : tracer.surroundings(positions))
    valid.push_back(backs >= kBacks && backs > 1 - open - backs ? 0 : 1);
  return valid;
}

BakedProbes encoded(const ProbeFormat& format, const GridLight& light, std::size_t first,
                    const ProbeGrid& grid, std::vector<std::uint8_t> valid, bool dilate,
                    int threads) {
  BakedProbes baked{.grid = grid, .coefficients = {}, .valid = std::move(valid)};
  baked.filled = dilate && std::ranges::count(baked.valid, 1) > 0;
  baked.coefficients.resize(grid.size() * format.size);
  for_all(grid.size(), threads, "encoding", [&](std::size_t probe) {
    std::vector<glm::dvec3> integrals(format.moments.count);
    for (std::size_t i = 0; i < integrals.size(); ++i)
      integrals[i] = glm::dvec3(light.integrals[probe * light.count + first + i]);
    const std::vector<glm::dvec3> made = format.encoded(integrals);
    for (std::size_t i = 0; i < format.size; ++i) {
      const glm::vec3 coefficient(made[i]);
      require_finite(coefficient, grid, probe);
      baked.coefficients[probe * format.size + i] = coefficient;
    }
  });
  if (dilate) dilate_into(grid, format.size, baked.valid, baked.coefficients, threads);
  std::vector<double> negative(grid.size());
  for_all(grid.size(), threads, "checking normals", [&](std::size_t probe) {
    const auto of = std::span(baked.coefficients).subspan(probe * format.size, format.size);
    negative[probe] = negative_share(format, std::vector<glm::dvec3>(of.begin(), of.end()));
  });
  for (const double share : negative) baked.negative += share / static_cast<double>(grid.size());
  return baked;
}

}  // namespace clpv::bake
