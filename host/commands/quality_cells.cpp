// SPDX-License-Identifier: MIT
#include "commands/quality_cells.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "evaluate/quality_report.hpp"
#include "parallel/schedule.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/progress.hpp"

namespace clpv {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Where a cell is in the matrix; `group`: of those that one frame serves.
struct Place {
  std::size_t subject, variant, view, group;
};

/// A quality run at one rank.
class Cells {
 public:
  Cells(Session& session, const QualityMatrix& matrix, const QualityStore& store)
      : session_(session), matrix_(matrix), store_(store) {
    std::size_t group = 0;
    for (std::size_t s = 0; s < matrix.subjects.size(); ++s) {
      for (std::size_t v = 0; v < matrix.variants.size(); ++v, ++group) {
        for (std::size_t view = 0; view < matrix.subjects[s].cameras.size(); ++view)
          places_.push_back({s, v, view, group});
      }
    }
    cells_.resize(places_.size());
  }

  std::size_t size() const { return places_.size(); }
  const std::optional<QualityCell>& operator[](std::size_t i) const { return cells_[i]; }
  std::string name_of(std::size_t i) const;

  /// What is kept, and who does what of the rest: pieces to be handed out in their order.
  std::vector<Piece> plan(int ranks);
  /// Measures a cell and keeps it.
  void measure(std::size_t i);
  /// The cells of this rank as text, and those of other ranks.
  std::string told() const;
  void take(const std::string& told);

 private:
  const Subject& subject(const Place& place) const { return matrix_.subjects[place.subject]; }
  const RenderOptions& options(const Place& place) const {
    return matrix_.options[place.subject][place.variant];
  }
  std::string key(const Place& place) const {
    return quality_key(subject(place).truths[place.view], session_.device(), options(place), matrix_.show,
                       matrix_.frames);
  }
  QualityCell rendered(const Place& place);
  std::vector<double> costs(const std::vector<std::optional<QualityCell>>& kept) const;

  Session& session_;
  const QualityMatrix& matrix_;
  const QualityStore& store_;
  std::vector<Place> places_;
  std::vector<std::optional<QualityCell>> cells_;
  std::optional<std::size_t> group_;  // that frame_ is of
  std::unique_ptr<Frame> frame_;      // none where it cannot be made
};

std::string Cells::name_of(std::size_t i) const {
  const Place& place = places_[i];
  return fmt::format("cell {}:{} {}", subject(place).scene.name, subject(place).cameras[place.view].name,
                     describe(matrix_.variants[place.variant]));
}

std::vector<Piece> Cells::plan(int ranks) {
  std::vector<std::optional<QualityCell>> kept;
  std::vector<std::vector<std::size_t>> groups(places_.back().group + 1);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    kept.push_back(store_.find(key(places_[i])));
    if (!kept[i] || matrix_.fresh) {
      groups[places_[i].group].push_back(i);
    } else {
      cells_[i] = kept[i];
      cells_[i]->variant =
          matrix_.variants[places_[i].variant];  // the same options may have been written otherwise
    }
  }
  if (ranks == 1) return groups;  // in their own order
  return longest_first(groups, costs(kept), ranks);
}

/// Of each cell: as kept ones of its group took, else estimated in their measure.
std::vector<double> Cells::costs(const std::vector<std::optional<QualityCell>>& kept) const {
  std::vector<double> took(places_.back().group + 1, 0), known(took), estimated(took);
  std::vector<double> counts(took);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const std::size_t group = places_[i].group;
    if (estimated[group] == 0) estimated[group] = estimated_cost(options(places_[i]));
    if (!kept[i]) continue;
    took[group] += kept[i]->made_s + kept[i]->measured_s;
    counts[group] += 1;
  }
  double measured = 0, estimates = 0;
  for (std::size_t g = 0; g < took.size(); ++g) {
    if (counts[g] == 0) continue;
    known[g] = took[g] / counts[g];
    measured += known[g], estimates += estimated[g];
  }
  const double scale = estimates > 0 ? measured / estimates : 1;
  std::vector<double> costs;
  for (const Place& place : places_)
    costs.push_back(counts[place.group] > 0 ? known[place.group] : scale * estimated[place.group]);
  return costs;
}

void Cells::measure(std::size_t i) {
  const Place& place = places_[i];
  QualityCell cell = rendered(place);
  cell.scene = subject(place).scene.name;
  cell.camera = subject(place).cameras[place.view].name;
  cell.variant = matrix_.variants[place.variant];
  if (cell.refused.empty()) store_.keep(key(place), cell);  // what was refused may be a matter of the moment
  cells_[i] = std::move(cell);
}

QualityCell Cells::rendered(const Place& place) {
  const Clock::time_point started = Clock::now();
  try {
    double made_s = 0;
    if (group_ != place.group) {
      frame_.reset();  // first of all: there may not be room for both
      group_ = place.group;
    }
    if (!frame_) {
      frame_ = std::make_unique<Frame>(session_, subject(place).scene, options(place));
      made_s = seconds_since(started);
    }
    QualityCell cell = clpv::measure(session_, *frame_, subject(place).cameras[place.view],
                                     subject(place).truths[place.view], matrix_.show, matrix_.frames);
    cell.made_s = made_s;
    cell.measured_s = seconds_since(started) - made_s;
    return cell;
  } catch (const Error& error) {
    // A basis that a transport cannot carry, a grid that does not fit: a result like any other.
    if (error.code() != ExitCode::usage && error.code() != ExitCode::run_time) throw;
    QualityCell cell;
    cell.refused = error.what();
    cell.measured_s = seconds_since(started);
    return cell;
  }
}

std::string Cells::told() const {
  nlohmann::json all = nlohmann::json::array();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i]) all.push_back({i, to_json(*cells_[i])});
  }
  return all.dump();
}

void Cells::take(const std::string& told) {
  for (const nlohmann::json& one : nlohmann::json::parse(told))
    cells_[one.at(0).get<std::size_t>()] = cell_from_json(one.at(1));
}

}  // namespace

std::vector<QualityCell> measure_all(Team& team, Session& session, const QualityMatrix& matrix,
                                     const QualityStore& store) {
  Cells cells(session, matrix, store);
  if (cells.size() == 0) return {};
  const std::string plan = team.from_first([&] { return nlohmann::json(cells.plan(team.size())).dump(); });
  const auto pieces = nlohmann::json::parse(plan).get<std::vector<Piece>>();
  std::size_t left = 0, now = 0;
  for (const Piece& piece : pieces) left += piece.size();
  const std::size_t there = cells.size() - left;
  Progress progress("quality", cells.size());
  const auto kept = [&] {
    return fmt::format("{} of {} cells are kept; the same command goes on", there + team.done(0),
                       cells.size());
  };
  team.share({pieces.size(),
              [&](std::size_t piece) {
                for (const std::size_t i : pieces[piece]) {
                  now = i;
                  if (interrupted()) throw Interrupted(kept());
                  cells.measure(i);
                  team.done(1);
                }
              },
              [&] { return cells.name_of(now); }, &progress, kept});
  for (const std::string& told : team.gather(cells.told())) cells.take(told);
  std::vector<QualityCell> all;
  for (std::size_t i = 0; team.leads() && i < cells.size(); ++i) all.push_back(*cells[i]);
  return all;
}

}  // namespace clpv
