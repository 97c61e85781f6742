// SPDX-License-Identifier: MIT
// What `clpv tune` found best for a device, kept between runs in the user's cache.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "basis/transport.hpp"
#include "device/device.hpp"
#include "options/choices.hpp"

namespace clpv {

struct RenderOptions;

/// What a tuning is for: one propagation. Results do not depend on it but for rounding.
struct TuningSubject {
  std::string basis;
  TransportKind transport;
  State state;
  int grid;
  Storage storage;
  std::optional<Layout> layout;  ///< none: the best layout is asked for; else the best shape on this one
};

/// The propagation of these options; `any_layout`: without their layout.
TuningSubject tuning_subject(const RenderOptions& options, bool any_layout = false);

/// Work-group size along x, y and cells a work-item serves (StencilOptions); and the layout they are for.
struct Tuning {
  std::array<std::size_t, 2> local = {0, 1};
  int lanes = 0;
  Layout layout = Layout::soa;
  bool operator==(const Tuning&) const = default;
};

/// One file a subject and device, which holds the whole key and is written beside its place, then renamed: processes may
/// read and write one folder at once.
class TuningCache {
 public:
  explicit TuningCache(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// In the user's cache folder; none where there is none.
  static std::optional<TuningCache> of_user();

  /// Nothing where none is stored; nor, with a warning, where the file is damaged, of other kernels or out of range.
  std::optional<Tuning> load(const Device& device, const TuningSubject& subject) const;
  /// Throws Error(run_time) where it cannot be written.
  void store(const Device& device, const TuningSubject& subject, const Tuning& tuning) const;

  std::filesystem::path file_of(const Device& device, const TuningSubject& subject) const;

 private:
  std::filesystem::path folder_;
};

/// The user's tuning for frames of these options, told at -v; the usual shapes where there is none. `choose_layout`:
/// options.layout becomes the tuned one.
Tuning tuning_for(const Device& device, RenderOptions& options, bool choose_layout);

}  // namespace clpv
