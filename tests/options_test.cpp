// SPDX-License-Identifier: MIT
// The options of a frame: each goes from text to a value and back, what is no value is rejected with those that are, and
// every enumeration that stands for a choice has all its names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "bench/row.hpp"
#include "image/tone_map.hpp"
#include "options/presets.hpp"
#include "options/render_options.hpp"
#include "options/show.hpp"
#include "options/stage_options.hpp"
#include "options/stages.hpp"
#include "scene/light_kind.hpp"
#include "support/named_enum.hpp"
#include "tests/support/error_of.hpp"

namespace clpv::options_test {
namespace {

using ::testing::HasSubstr;

std::string value_of(const RenderOptions& options, const std::string& name) {
  for (const OptionDescription& info : list_options(options)) {
    if (info.name == name) return info.value;
  }
  return "not listed";
}

std::vector<std::string> choices_in(const std::string& allowed) {
  std::vector<std::string> choices;
  std::istringstream words(allowed);
  for (std::string word; std::getline(words, word, '|');) choices.push_back(word);
  return choices;
}

TEST(Options, EveryChoiceGoesFromTextToAValueAndBack) {
  for (const OptionDescription& info : list_options(RenderOptions{})) {
    if (info.allowed.find('|') == std::string::npos) continue;
    SCOPED_TRACE(info.name);
    std::set<std::string> seen;
    for (const std::string& choice : choices_in(info.allowed)) {
      RenderOptions options;
      set_option(options, info.name, choice);
      EXPECT_EQ(value_of(options, info.name), choice);
      EXPECT_TRUE(seen.insert(to_json(options).at(info.name).dump()).second) << choice << " is like another";
    }
    EXPECT_GE(seen.size(), 2u);
  }
}

TEST(Options, EveryNumberAndFileGoesFromTextToAValueAndBack) {
  const std::map<std::string, std::string> others = {
      {"centres", "mine.json"}, {"lambda", "0.375"}, {"table-size", "99"},     {"iterations", "3"},
      {"grid", "17"},           {"cascades", "2"},   {"cascade-size", "6.25"}, {"rsm-size", "64"},
      {"shadow-size", "128"},   {"width", "31"},     {"blocker-stride", "2"},  {"height", "17"},
      {"gather-offset", "1.5"}};
  std::size_t found = 0;
  for (const OptionDescription& info : list_options(RenderOptions{})) {
    if (info.allowed.find('|') != std::string::npos) continue;
    SCOPED_TRACE(info.name);
    ASSERT_TRUE(others.contains(info.name));
    RenderOptions options;
    set_option(options, info.name, others.at(info.name));
    EXPECT_EQ(value_of(options, info.name), others.at(info.name));
    ++found;
  }
  EXPECT_EQ(found, others.size());
}

TEST(Options, TheirDefaultsAreTextsTheyTake) {
  RenderOptions options;
  for (const OptionDescription& info : list_options(RenderOptions{})) {
    if (info.name != "centres") set_option(options, info.name, info.value);
  }
  EXPECT_EQ(to_json(options), to_json(RenderOptions{}));
}

TEST(Options, WhatIsMisspeltIsRejectedWithTheValueAndWhatIsAllowed) {
  for (const OptionDescription& info : list_options(RenderOptions{})) {
    SCOPED_TRACE(info.name);
    for (const std::string& bad : {info.value + "x", std::string()}) {
      if (info.name == "centres" && !bad.empty()) continue;  // any text may name a file
      RenderOptions options;
      EXPECT_EQ(test::error_of(ExitCode::usage, [&] { set_option(options, info.name, bad); }),
                info.name + ": found '" + bad + "', allowed: " + info.allowed);
      EXPECT_EQ(to_json(options), to_json(RenderOptions{})) << "changed all the same";
    }
  }
  RenderOptions options;
  EXPECT_THROW(set_option(options, "colour", "red"), Error);
}

TEST(Options, ABasisReplacesAFileOfCentres) {
  RenderOptions options;
  set_option(options, "centres", "mine.json");
  set_option(options, "basis", "sh2");
  EXPECT_EQ(options.centres, "");
}

TEST(Options, AllPresetsApply) {
  for (const PresetName preset : values_of<PresetName>()) {
    RenderOptions options;
    set_option(options, "grid", "9");
    apply_preset(options, preset);
    EXPECT_EQ(options.preset, preset);
    EXPECT_EQ(options.grid, 9);
    if (preset != PresetName::paper) continue;
    for (const auto& [name, value] : paper_options())
      EXPECT_EQ(value_of(options, std::string(name)), value) << name;
  }
}

TEST(Options, StagesAreToldWhatWasChosen) {
  RenderOptions options;
  apply_preset(options, PresetName::paper);
  options.table = TableStorage::image, options.grid = 11, options.state = State::fluxes;
  const InjectOptions inject = inject_options(options, true);
  EXPECT_TRUE(inject.unit_flux_lobes);
  EXPECT_EQ(inject.grid, 11);
  EXPECT_EQ(inject.blocking, Blocking::one_sided);
  EXPECT_EQ(inject.lobes.kind, LobeKind::rotate);
  EXPECT_EQ(inject.table, TableStorage::image);
  const PropagateOptions propagate = propagate_options(options);
  EXPECT_EQ(propagate.state, State::fluxes);
  EXPECT_EQ(propagate.lobe_time, LobeTime::kernel);
  EXPECT_EQ(propagate.format, (VolumeFormat{Layout::image, Storage::float16}));
  options.cascades = 3, options.directions = Directions::of216, options.coarser_directions = Directions::of96;
  EXPECT_EQ(sweep_options(options).parts, (std::vector<int>{3, 2, 2}));
  EXPECT_EQ(sweep_options(options).grid, 11);
  const GatherOptions gather = gather_options(options);
  EXPECT_TRUE(gather.lobes.table_functions);
  EXPECT_EQ(gather.table, TableStorage::image);
}

/// A row's names of a benchmark tell lobes apart as charts and earlier runs know them.
TEST(Options, BenchmarksNameLobes) {
  RenderOptions options = bench::timed_options();
  EXPECT_EQ(bench::lobes_of(options), "exact");
  options.lobe = LobeKind::rotate;
  EXPECT_EQ(bench::lobes_of(options), "rotate");
  options.lobe_time = LobeTime::kernel;
  EXPECT_EQ(bench::lobes_of(options), "rotate-kernel");
}

/// Those that are no options, which the tests above go through.
template <typename E>
class EachNamedEnum : public ::testing::Test {};
using NamedEnums = ::testing::Types<Show, ToneMap, LightKind, Stage, Pass>;
TYPED_TEST_SUITE(EachNamedEnum, NamedEnums);

TYPED_TEST(EachNamedEnum, HasANameOfItsOwnForEachValueAndReadsItBack) {
  const auto values = values_of<TypeParam>();
  ASSERT_GE(values.size(), 2u);
  std::set<std::string> names;
  for (const TypeParam value : values) {
    EXPECT_TRUE(names.insert(std::string(name_of(value))).second) << name_of(value);
    EXPECT_EQ(named<TypeParam>("it", name_of(value)), value);
  }
  EXPECT_EQ(name_of(static_cast<TypeParam>(values.size())), "");
}

TYPED_TEST(EachNamedEnum, RejectsOthersAndListsThem) {
  const std::string bad = std::string(name_of(values_of<TypeParam>().front())) + "s";
  const std::string message = test::error_of(ExitCode::usage, [&] { named<TypeParam>("it", bad); });
  EXPECT_THAT(message, HasSubstr("it: found '" + bad + "', allowed: "));
  for (const std::string& name : names_of<TypeParam>()) EXPECT_THAT(message, HasSubstr(name));
}

}  // namespace
}  // namespace clpv::options_test
