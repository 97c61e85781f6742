// SPDX-License-Identifier: MIT
// Command lines that ask for what cannot be: each is told before a scene is read or a device is asked.
#include "tests/support/hostile.hpp"

namespace clpv::test {
namespace {

const std::string kCornell = CLPV_SOURCE_DIR "/scenes/cornell.json";

/// What is wrong with a frame's options; the scene is sound.
HostileInput frame(const std::string& name, const std::string& options, std::vector<std::string> words) {
  return {name, "render " + kCornell + " -o @/out.exr " + options, 2, std::move(words)};
}

TEST(HostileCommandLines, OfFrames) {
  expect_all_refused(
      {
          frame("a basis of no name", "--basis sh99", {"basis", "sh99", "sh2"}),
          frame("an empty basis", "--basis ''", {"basis", "sh2"}),
          frame("a transport of no name", "--transport warp", {"transport", "warp", "sweep"}),
          frame("a layout of no name", "--layout zigzag", {"layout", "zigzag", "soa"}),
          frame("a storage of no name", "--storage double", {"storage", "double", "half"}),
          frame("a preset of no name", "--preset worst", {"preset", "worst", "paper"}),
          frame("a view of no name", "--view inside", {"--view", "inside", "indirect"}),
          frame("a tone map of no name", "--tonemap sepia", {"--tonemap", "sepia"}),
          frame("no cells", "--grid 0", {"grid", "'0'", "1..512"}),
          frame("cells below none", "--grid -1", {"grid", "1..512"}),
          frame("cells without end", "--grid 99999999999999999999", {"grid", "1..512"}),
          frame("cells in hexadecimal", "--grid 0x10", {"grid", "0x10", "1..512"}),
          frame("cells with a fraction", "--grid 32.5", {"grid", "32.5"}),
          frame("cells and words", "--grid 32cells", {"grid", "32cells"}),
          frame("cells after a blank", "--grid ' 32'", {"grid", "1..512"}),
          frame("no cascades", "--cascades 0", {"cascades", "1..8"}),
          frame("too many cascades", "--cascades 9", {"cascades", "1..8"}),
          frame("a cascade of no size", "--cascade-size 0", {"cascade-size", "neither included"}),
          frame("a cascade of no number", "--cascade-size nan", {"cascade-size", "nan"}),
          frame("a cascade without end", "--cascade-size inf", {"cascade-size", "inf"}),
          frame("a cascade below none", "--cascade-size -3", {"cascade-size"}),
          frame("no pixels", "--width 0", {"width", "1..16384"}),
          frame("too many pixels", "--height 16385", {"height", "1..16384"}),
          frame("a map of no texels", "--rsm-size 0", {"rsm-size", "1..8192"}),
          frame("a map of too many texels", "--rsm-size 8193", {"rsm-size", "1..8192"}),
          frame("a shadow of no texels", "--shadow-size -8", {"shadow-size"}),
          frame("a bandwidth of none", "--lambda 0 --basis srbf4", {"lambda", "between 0 and 1"}),
          frame("a bandwidth of all", "--lambda 1 --basis srbf4", {"lambda", "between 0 and 1"}),
          frame("a bandwidth of no number", "--lambda nan --basis srbf4", {"lambda"}),
          frame("a bandwidth that cannot be told apart", "--lambda 0.0000001 --basis srbf8v2", {"lambda"}),
          frame("a table of one entry", "--table-size 1", {"table-size", "2..65536"}),
          frame("a table too large", "--table-size 65537", {"table-size", "2..65536"}),
          frame("steps without end", "--iterations 4097", {"iterations", "0..4096"}),
          frame("occlusion perhaps", "--occlusion maybe", {"occlusion", "maybe", "on|off"}),
          frame("a stride of none", "--blocker-stride 0", {"blocker-stride", "1..16"}),
          frame("an offset too far", "--gather-offset 5", {"gather-offset", "0..4"}),
          frame("bounces of no number", "--bounces 3", {"bounces", "1|2|all"}),
          frame("bounces without a sweep", "--bounces 2 --transport exact", {"bounces"}),
          frame("fluxes through no faces", "--state fluxes", {"fluxes"}),
          frame("no frames", "--frames 0", {"--frames"}),
          frame("frames without end", "--frames 1001", {"--frames"}),
          frame("a time without end", "--time 1e300", {"--time", "-1000000..1000000"}),
          frame("an exposure of no number", "--exposure bright", {"--exposure"}),
          frame("an option of no name", "--frobnicate 3", {"--frobnicate"}),
          frame("an option twice", "--grid 8 --grid 16", {"--grid"}),
          frame("an option without its value", "--grid", {"--grid"}),
          frame("control characters", "--basis \"$(printf 'a\\033[31mb')\"", {"basis"}),
          frame("bytes that are no text", "--basis \"$(printf '\\377\\376')\"", {"basis"}),
      },
      48);
}

TEST(HostileCommandLines, OfCommands) {
  expect_all_refused(
      {
          {"no scene", "render -o @/out.exr", 2, {"scene"}},
          {"no output", "render " + kCornell, 2, {"--output"}},
          {"two scenes", "render " + kCornell + " " + kCornell + " -o @/out.exr", 2, {"cornell.json"}},
          {"an output of another kind", "render " + kCornell + " -o @/out.bmp", 2, {"'.bmp'", ".exr, .png"}},
          {"an output of no kind", "render " + kCornell + " -o @/out", 2, {"''", ".exr, .png"}},
          {"a word for a command", "paint it", 2, {"'paint'", "render"}},
          {"a letter too many", "renderr " + kCornell, 2, {"did you mean render?"}},
          {"two commands", "devices check", 2, {"check"}},
          {"a suite of no name", "bench everything", 2, {"everything"}},
          {"a suite of an empty name", "bench ''", 2, {"suite"}},
          {"an expression that is none", "bench bases --filter '('", 2, {"--filter", "regular expression"}},
          {"no repetitions", "bench bases --repetitions 0", 2, {"--repetitions"}},
          {"repetitions without end", "bench bases --repetitions 99999", 2, {"--repetitions"}},
          {"a format of no name", "bench bases --format xml", 2, {"--format", "csv"}},
          {"a basis of no name, timed", "bench bases --basis sh99", 2, {"sh99"}},
          {"a model of no scene", "bench bases --model a.gltf", 2, {"--model", "--scene"}},
          {"two documents on stdout",
           "bench bases --format json --compare @/a.json",
           2,
           {"--compare", "stdout"}},
          {"a stage of no name", "check --stage cook", 2, {"--stage", "gather"}},
          {"a cell outside", "propagate --at 99,0,0 --grid 8 -o @/out.npy", 2, {"--at", "99"}},
          {"two numbers for three", "propagate --at 1,2", 2, {"--at", "'1,2'"}},
          {"four numbers for three", "propagate --at 1,2,3,4", 2, {"--at", "'1,2,3,4'"}},
          {"numbers too long", "propagate --at 99999999999,0,0", 2, {"--at"}},
          {"a flux of no numbers",
           "propagate --at 4,4,4 --flux red,green,blue",
           2,
           {"--flux", "'red,green,blue'"}},
          {"a flux that is not finite", "propagate --at 4,4,4 --flux 1e999,0,0", 2, {"--flux"}},
          {"half a box", "propagate --at 4,4,4 --block 0,0,0", 2, {"--block", "two corners"}},
          {"a box the wrong way round", "propagate --at 4,4,4 --block 3,3,3:1,1,1", 2, {"--block", "beyond"}},
          {"an axis of no length", "basis sh2 --axis 0,0,0", 2, {"--axis"}},
          {"an axis of no numbers", "basis sh2 --axis up", 2, {"--axis", "'up'"}},
          {"a basis of no name, told of", "basis sh99", 2, {"sh99", "sh2"}},
          {"no centres searched", "basis --search 0", 2, {"--search"}},
          {"centres without end", "basis --search 100000", 2, {"--search"}},
          {"a film of no frames", "sequence " + kCornell + " -o @/film --frames 0 --fps 24", 2, {"--frames"}},
          {"a film at no speed",
           "sequence " + kCornell + " -o @/film --frames 2 --fps 0",
           2,
           {"--fps", "more than 0"}},
          {"a film at no number", "sequence " + kCornell + " -o @/film --frames 2 --fps nan", 2, {"--fps"}},
          {"a film past the end of time",
           "sequence " + kCornell + " -o @/film --frames 1000000 --fps 0.001",
           2,
           {"--frames", "1000000 s"}},
          {"a film of another kind",
           "sequence " + kCornell + " -o @/film --frames 2 --fps 1 --video @/out.gif",
           2,
           {"--video", "'.gif'", ".mp4"}},
          {"noise of nothing",
           "sequence " + kCornell + " -o @/film --frames 2 --fps 1 --traced 4",
           2,
           {"--traced", "--stability"}},
          {"a variant of no option", "quality " + kCornell + " --vary colour=red", 2, {"colour"}},
          {"a variant of no value", "quality " + kCornell + " --vary grid", 2, {"vary grid", "OPTION=a,b,c"}},
          {"references of two sizes",
           "quality " + kCornell + " --vary width=8,16",
           2,
           {"--vary", "one size"}},
          {"a view of no name, judged", "quality " + kCornell + " --view inside", 2, {"--view", "inside"}},
          {"a difference of another kind", "compare a.exr b.exr -o @/out.tif", 2, {"'.tif'"}},
          {"a factor below none", "compare a.exr b.exr --amplify -1", 2, {"--amplify"}},
          {"a device of no number", "--device 99 devices2", 2, {"devices"}},
      },
      44);
}

TEST(HostileCommandLines, OfDevices) {
  expect_all_refused(
      {
          {"a device that is not there", "--device 99 check --stage sizes", 4, {"'99'"}},
          {"a device of no name", "--device 'no such thing' check --stage sizes", 4, {"no such thing"}},
          {"a device below none", "--device=-1 check --stage sizes", 4, {"'-1'"}},
          {"a platform that is not there", "--device 7:7 check --stage sizes", 4, {"'7:7'"}},
          {"a device by the environment", "check --stage sizes", 4, {"'99'"}, {}, {}, "CLPV_DEVICE=99"},
          {"no device at all",
           "check --stage sizes",
           4,
           {"no OpenCL device found"},
           {},
           {},
           "OCL_ICD_VENDORS=/nowhere CLPV_DEVICE="},
      },
      6);
}

}  // namespace
}  // namespace clpv::test
