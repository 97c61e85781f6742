#include "bench/propagate_twin.hpp"

#include <algorithm>

namespace clpv::bench {
namespace {

using reference::Volume;

/// One way into a cell: from the neighbour light comes from, and the share it lets through (a plane; empty: all).
struct Way {
  glm::ivec3 travel;
  std::vector<double> open;
};

/// A row of cells along x at (y, z).
struct Row {
  int n, y, z;
  std::size_t at(int plane) const { return ((static_cast<std::size_t>(plane) * n + z) * n + y) * n; }
};

/// Cells x of the row whose neighbour x - travel lies in the grid, and where that neighbour's row starts.
struct Reach {
  int first, last;
  bool any;
  Row from;
};

Reach reach(const Row& row, const glm::ivec3& travel) {
  const Row from{row.n, row.y - travel.y, row.z - travel.z};
  const bool inside = from.y >= 0 && from.y < row.n && from.z >= 0 && from.z < row.n;
  return {std::max(0, travel.x), row.n + std::min(0, travel.x), inside, from};
}

/// 1 - B for every cell: B the mean blocker over the corners towards `side`, looked up in `direction`.
std::vector<double> transmittance(const Volume& geometry, const glm::ivec3& side,
                                  const std::vector<double>& weights) {
  const int n = geometry.n - 1;
  std::vector<double> open(static_cast<std::size_t>(n) * n * n, 0.0);
  int corners = 0;
  for (int c = 0; c < 8; ++c) {
    const glm::ivec3 corner(c & 1, (c >> 1) & 1, c >> 2);
    bool towards = true;
    for (int axis = 0; axis < 3; ++axis)
      towards = towards && (side[axis] == 0 || corner[axis] == (side[axis] > 0 ? 1 : 0));
    if (!towards) continue;
    ++corners;
    for (int i = 0; i < geometry.coefficients; ++i) {
      for (int z = 0; z < n; ++z) {
        for (int y = 0; y < n; ++y) {
          double* out = open.data() + (static_cast<std::size_t>(z) * n + y) * n;
          const double* from =
              geometry.values.data() + geometry.index(0, i, corner.x, y + corner.y, z + corner.z);
          for (int x = 0; x < n; ++x) out[x] += weights[static_cast<std::size_t>(i)] * from[x];
        }
      }
    }
  }
  for (double& value : open) value = 1.0 - std::clamp(value / corners, 0.0, 1.0);
  return open;
}

std::vector<Way> ways_of(const Transport& transport, const Volume* geometry) {
  std::vector<Way> ways;
  if (const auto* faces = std::get_if<FaceTransport>(&transport.scheme)) {
    for (const Face& face : faces->faces) {
      ways.push_back({face.travel, {}});
      if (geometry != nullptr) ways.back().open = transmittance(*geometry, face.normal, face.blocked_by);
    }
    return ways;
  }
  for (const auto& neighbour : std::get<OperatorTransport>(transport.scheme).neighbours) {
    ways.push_back({neighbour.offset, {}});
    if (geometry != nullptr && neighbour.offset != glm::ivec3(0))
      ways.back().open = transmittance(*geometry, -neighbour.offset, neighbour.blocked_by);
  }
  return ways;
}

/// Rows of one channel: sum over way's neighbour of weights[i] * plane i, into `out`.
void weigh_neighbours(const Volume& from, int channel, const Reach& reach, const glm::ivec3& travel,
                      const double* weights, std::vector<double>& out) {
  std::fill(out.begin(), out.end(), 0.0);
  for (int i = 0; i < from.coefficients; ++i) {
    if (weights[i] == 0) continue;
    const double* source = from.values.data() + reach.from.at(channel * from.coefficients + i) - travel.x;
    for (int x = reach.first; x < reach.last; ++x) out[static_cast<std::size_t>(x)] += weights[i] * source[x];
  }
}

class Stepper {
 public:
  Stepper(const Transport& transport, const std::vector<Way>& ways, bool blocking, const Volume& from,
          Volume& to)
      : ways_(ways), blocking_(blocking), from_(from), to_(to), flux_(static_cast<std::size_t>(from.n)) {
    faces_ = std::get_if<FaceTransport>(&transport.scheme);
    if (faces_ == nullptr) operators_ = &std::get<OperatorTransport>(transport.scheme);
  }

  void row(int channel, int y, int z) {
    const Row row{from_.n, y, z};
    for (std::size_t w = 0; w < ways_.size(); ++w) {
      const Reach reached = reach(row, ways_[w].travel);
      if (!reached.any) continue;
      if (faces_ != nullptr) {
        through_face(w, channel, row, reached);
      } else {
        by_operator(w, channel, row, reached);
      }
    }
  }

 private:
  double open(std::size_t way, const Row& row, int x) const {
    const std::vector<double>& open = ways_[way].open;
    return blocking_ && !open.empty() ? open[row.at(0) + static_cast<std::size_t>(x)] : 1.0;
  }
  void add(int plane, const Row& row, const Reach& reached, double factor) {
    double* out = to_.values.data() + row.at(plane);
    for (int x = reached.first; x < reached.last; ++x) out[x] += factor * flux_[static_cast<std::size_t>(x)];
  }
  void through_face(std::size_t way, int channel, const Row& row, const Reach& reached) {
    const Face& face = faces_->faces[way];
    weigh_neighbours(from_, channel, reached, face.travel, face.flux.data(), flux_);
    for (int x = reached.first; x < reached.last; ++x) {
      double& flux = flux_[static_cast<std::size_t>(x)];
      flux = std::max(0.0, flux) * open(way, row, x);
    }
    const auto column = static_cast<int>(std::find(kAxes.begin(), kAxes.end(), face.normal) - kAxes.begin());
    for (int i = 0; i < from_.coefficients; ++i)
      add(channel * from_.coefficients + i, row, reached, faces_->lobes(i, column));
  }
  void by_operator(std::size_t way, int channel, const Row& row, const Reach& reached) {
    const auto& neighbour = operators_->neighbours[way];
    for (int r = 0; r < from_.coefficients; ++r) {
      weigh_neighbours(from_, channel, reached, neighbour.offset, neighbour.weights.row(r).data(), flux_);
      for (int x = reached.first; x < reached.last; ++x)
        flux_[static_cast<std::size_t>(x)] *= open(way, row, x);
      add(channel * from_.coefficients + r, row, reached, 1.0);
    }
  }

  const FaceTransport* faces_ = nullptr;
  const OperatorTransport* operators_ = nullptr;
  const std::vector<Way>& ways_;
  bool blocking_;
  const Volume& from_;
  Volume& to_;
  std::vector<double> flux_;  // of the row at hand
};

}  // namespace

std::vector<double> propagated(const Transport& transport, const Volume& injected, const Volume* geometry,
                               int iterations) {
  const std::vector<Way> ways = ways_of(transport, geometry);
  Volume travelling = injected;
  std::vector<double> accumulated = injected.values;
  for (int step = 1; step <= iterations; ++step) {
    Volume next(injected.n, injected.coefficients, injected.channels);
    Stepper stepper(transport, ways, step > 1, travelling, next);
    for (int channel = 0; channel < injected.channels; ++channel) {
      for (int z = 0; z < injected.n; ++z) {
        for (int y = 0; y < injected.n; ++y) stepper.row(channel, y, z);
      }
    }
    travelling = std::move(next);
    for (std::size_t i = 0; i < accumulated.size(); ++i) accumulated[i] += travelling.values[i];
  }
  return accumulated;
}

}  // namespace clpv::bench
