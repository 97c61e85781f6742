// SPDX-License-Identifier: MIT
// Adding to volumes of every layout: sums end where they should, and take the memory they say.
#include "volume/accumulator.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/on_device.hpp"

namespace clpv::accumulator_test {
namespace {

using test::test_session;

constexpr VolumeShape kShape{5, 6, 3};

std::vector<VolumeFormat> formats() {
  std::vector<VolumeFormat> all;
  for (const VolumeFormat& format : all_formats()) {
    if (!unsupported(test_session().device(), format, kShape)) all.push_back(format);
  }
  return all;
}

std::vector<float> counted() {
  std::vector<float> values(5 * 5 * 5 * 6 * 3);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 1000);
  return values;
}

std::vector<float> with_one_more(std::vector<float> values) {
  for (float& value : values) value += 1;
  return values;
}

/// As a kernel would: reads one volume, writes another, or the same where a launch may.
void add_one(const Volume& so_far, const Volume& next) {
  EXPECT_EQ(so_far.memory()() == next.memory()(), updates_in_place(so_far.format()));
  Volume written = next;
  written.write(test_session(), with_one_more(so_far.read(test_session())));
}

TEST(Accumulator, AddsAgainAndAgainToAllCells) {
  for (const VolumeFormat& format : formats()) {
    SCOPED_TRACE(format_name(format));
    Accumulator accumulator(test_session());
    Volume one(test_session(), kShape, "one sum", format), other(test_session(), kShape, "other sum", format);
    one.write(test_session(), counted());
    for (int i = 0; i < 3; ++i) {
      accumulator.add(one, add_one);
      accumulator.add(other, add_one);
    }
    EXPECT_EQ(one.read(test_session()), with_one_more(with_one_more(with_one_more(counted()))));
    EXPECT_EQ(other.read(test_session()), std::vector<float>(counted().size(), 3.0f));
  }
}

TEST(Accumulator, AddsToSomeCellsInAFormatThatCanBeUpdated) {
  for (const VolumeFormat& format : formats()) {
    SCOPED_TRACE(format_name(format));
    Accumulator accumulator(test_session());
    Volume sum(test_session(), kShape, "sum", format);
    sum.write(test_session(), counted());
    std::vector<float> wanted = counted();
    wanted[77] = 5.5f;
    accumulator.add_to_cells(sum, [&](const Volume& cells) {
      EXPECT_EQ(cells.format(), Accumulator::cells_format(format));
      EXPECT_TRUE(updates_in_place(cells.format()));
      EXPECT_EQ(cells.read(test_session()), counted());
      Volume written = cells;
      written.write(test_session(), wanted);
    });
    EXPECT_EQ(sum.read(test_session()), wanted);
  }
}

TEST(Accumulator, TakesTheMemoryItSays) {
  Session& session = test_session();
  for (const VolumeFormat& format : formats()) {
    SCOPED_TRACE(format_name(format));
    Volume one(session, kShape, "one sum", format), other(session, kShape, "other sum", format);
    const std::size_t before = session.device_bytes();
    {
      Accumulator accumulator(session);
      for (Volume* sum : {&one, &other, &one}) {
        accumulator.add(*sum, [](const Volume&, const Volume&) {});
        EXPECT_EQ(session.device_bytes() - before, Accumulator::spare_bytes(format, kShape));
      }
    }
    EXPECT_EQ(session.device_bytes(), before) << "given back";
    Accumulator accumulator(session);
    for (Volume* sum : {&one, &other}) {
      accumulator.add_to_cells(*sum, [](const Volume&) {});
      EXPECT_EQ(session.device_bytes() - before, Accumulator::cells_bytes(format, kShape));
    }
  }
}

}  // namespace
}  // namespace clpv::accumulator_test
