// SPDX-License-Identifier: MIT
// Values of every render option, drawn from the option table by the input's bytes: resolved for a
// scene, with basis and transport, without a device.
#include "options/scene_options.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/support/random_options.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clpv;
  std::size_t next = 0;
  test::Choices choices([&](std::size_t end) -> std::size_t {
    std::size_t value = 0;
    for (std::size_t range = 1; range < end && next < size; range *= 256)
      value = value * 256 + data[next++];
    return value % end;
  });
  OptionValues given;
  const test::Caps caps{{"table-size", 4096}};  // larger ones only take longer
  for (const OptionDescription& option : list_options(RenderOptions{})) {
    if (choices.one_in(2)) continue;
    if (const std::string value = test::drawn_value(option, choices, caps); !value.empty())
      given[option.name] = value;
  }
  fuzz::read_or_reject({ExitCode::usage}, [&] {
    const RenderOptions options = resolve_options(given, SceneData{});
    const auto basis = make_basis(options);
    // Exact fluxes are integrals that take seconds under sanitizers.
    if (options.transport != TransportKind::exact) make_transport(options, *basis);
  });
  return 0;
}
