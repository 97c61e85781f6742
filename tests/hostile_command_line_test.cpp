// SPDX-License-Identifier: MIT
// Command lines that ask for what cannot be: each is rejected before a scene is read or a device is asked, with exit code 2 and
// words that name the option and what is allowed.
#include "tests/support/hostile.hpp"

namespace clpv::test::hostile_command_line_test {
namespace {

const std::string kCornell = CLPV_SOURCE_DIR "/scenes/cornell.json";

struct BadLine {
  std::string arguments;  ///< @ is a folder
  std::vector<std::string> words;
};

void expect_usage(const std::string& before, const std::vector<BadLine>& lines) {
  for (const auto& [arguments, words] : lines) expect_rejected({arguments, before + arguments, 2, words});
}

TEST(HostileCommandLines, OfFrames) {
  expect_usage("render " + kCornell + " -o @/out.exr ",
               {
                   {"--basis sh99", {"basis", "sh99", "sh2"}},
                   {"--transport warp", {"transport", "warp", "sweep"}},
                   {"--preset worst", {"preset", "worst", "paper"}},
                   {"--view inside", {"--view", "inside", "indirect"}},
                   {"--tonemap sepia", {"--tonemap", "sepia"}},
                   {"--grid 0", {"grid", "'0'", "1..512"}},
                   {"--grid -1", {"grid", "1..512"}},
                   {"--grid 99999999999999999999", {"grid", "1..512"}},
                   {"--grid 0x10", {"grid", "0x10", "1..512"}},
                   {"--grid 32.5", {"grid", "32.5"}},
                   {"--grid ' 32'", {"grid", "1..512"}},
                   {"--cascades 9", {"cascades", "1..8"}},
                   {"--cascade-size 0", {"cascade-size", "greater than 0"}},
                   {"--cascade-size nan", {"cascade-size", "nan"}},
                   {"--cascade-size inf", {"cascade-size", "inf"}},
                   {"--width 0", {"width", "1..16384"}},
                   {"--height 16385", {"height", "1..16384"}},
                   {"--rsm-size 8193", {"rsm-size", "1..8192"}},
                   {"--shadow-size -8", {"shadow-size"}},
                   {"--lambda 0 --basis srbf4", {"lambda", "between 0 and 1"}},
                   {"--lambda 1 --basis srbf4", {"lambda", "between 0 and 1"}},
                   {"--lambda 0.0000001 --basis srbf8v2", {"lambda"}},
                   {"--table-size 1", {"table-size", "2..65536"}},
                   {"--iterations 4097", {"iterations", "0..4096"}},
                   {"--occlusion maybe", {"occlusion", "maybe", "on|off"}},
                   {"--blocker-stride 0", {"blocker-stride", "1..16"}},
                   {"--gather-offset 5", {"gather-offset", "0..4"}},
                   {"--bounces 3", {"bounces", "1|2|all"}},
                   {"--bounces 2 --transport exact", {"bounces"}},
                   {"--frames 0", {"--frames"}},
                   {"--frames 1001", {"--frames"}},
                   {"--time nan", {"--time", "-1000000..1000000"}},
                   {"--time 1e300", {"--time", "-1000000..1000000"}},
                   {"--time 1s", {"--time", "-1000000..1000000"}},
                   {"--exposure bright", {"--exposure"}},
                   {"--frobnicate 3", {"--frobnicate"}},
                   {"--grid 8 --grid 16", {"--grid"}},
                   {"--grid", {"--grid"}},
                   {"--basis a\033[31mb", {"basis"}},
                   {"--basis \377\376", {"basis"}},
               });
}

TEST(HostileCommandLines, OfCommands) {
  const std::string film = "sequence " + kCornell + " -o @/out ", quality = "quality " + kCornell + " ",
                    truth = "pathtrace " + kCornell + " ";
  expect_usage("", {
                       {"render -o @/out.exr", {"scene"}},
                       {"render " + kCornell, {"--output"}},
                       {"render " + kCornell + " " + kCornell + " -o @/out.exr", {"cornell.json"}},
                       {"render " + kCornell + " -o @/out.bmp", {"'.bmp'", ".exr, .png"}},
                       {"render " + kCornell + " -o @/out", {"''", ".exr, .png"}},
                       {"paint it", {"'paint'", "render", "compare"}},
                       {"--quiet renderr " + kCornell, {"'renderr'", "did you mean render?"}},
                       {"reference scene.json -o a.exr", {"now 'pathtrace'"}},
                       {"qualtiy", {"did you mean quality?"}},
                       {"--quiet", {"subcommand"}},
                       {"--device 99 devices2", {"devices"}},
                       {"devices check", {"check"}},
                       {"bench everything", {"everything"}},
                       {"bench bases --filter (", {"--filter", "regular expression"}},
                       {"bench bases --repetitions 0", {"--repetitions"}},
                       {"bench bases --repetitions 99999", {"--repetitions"}},
                       {"bench bases --format xml", {"--format", "csv"}},
                       {"bench bases --basis sh99", {"sh99"}},
                       {"bench bases --model a.gltf", {"--model", "--scene"}},
                       {"bench bases --format json --compare @/a.json", {"--compare", "stdout"}},
                       {"check --stage cook", {"--stage", "gather"}},
                       {"check --stage see", {"--stage", "now 'visibility'"}},
                       {"propagate --at 99,0,0 --grid 8 -o @/out.npy", {"--at", "99"}},
                       {"propagate --at 1,2", {"--at", "'1,2'"}},
                       {"propagate --at 1,2,3,4", {"--at", "'1,2,3,4'"}},
                       {"propagate --at 99999999999,0,0", {"--at"}},
                       {"propagate --at 4,4,4 --flux red,green,blue", {"--flux", "'red,green,blue'"}},
                       {"propagate --at 4,4,4 --flux 1e999,0,0", {"--flux"}},
                       {"propagate --at 4,4,4 --block 0,0,0", {"--block", "two corners"}},
                       {"propagate --at 4,4,4 --block 3,3,3:1,1,1", {"--block", "beyond"}},
                       {"basis sh2 --axis 0,0,0", {"--axis"}},
                       {"basis sh2 --axis up", {"--axis", "'up'"}},
                       {"basis sh99", {"sh99", "sh2"}},
                       {"basis --search 0", {"--search"}},
                       {"basis --search 100000", {"--search"}},
                       {"compare a.exr", {"B"}},
                       {"compare a.exr b.exr -o @/out.tif", {"'.tif'"}},
                       {"compare a.exr b.exr --amplify -1", {"--amplify"}},
                       {"report", {"DIR"}},
                       {film + "--fps 24", {"--frames"}},
                       {film + "--frames 2", {"--fps"}},
                       {film + "--frames 0 --fps 24", {"--frames"}},
                       {film + "--frames 1.5 --fps 24", {"--frames"}},
                       {film + "--frames 2000000 --fps 24", {"--frames"}},
                       {film + "--frames 2 --fps 0", {"--fps: found '0', allowed: more than 0"}},
                       {film + "--frames 2 --fps -5", {"--fps: found '-5'"}},
                       {film + "--frames 2 --fps nan", {"--fps: found 'nan'"}},
                       {film + "--frames 2 --fps 1e9", {"--fps: found '1e9'"}},
                       {film + "--frames 2 --fps 1 --from nan", {"--from"}},
                       {film + "--frames 1000000 --fps 0.001", {"--frames", "1000000 s"}},
                       {film + "--frames 2 --fps 1 --format gif", {"--format"}},
                       {film + "--frames 2 --fps 1 --video @/out.gif", {"--video", "'.gif'", ".mp4"}},
                       {film + "--frames 2 --fps 1 --traced 4", {"--traced", "--stability"}},
                       {quality + "--vary colour=red", {"colour"}},
                       {quality + "--vary grid", {"vary grid", "OPTION=a,b,c"}},
                       {quality + "--vary width=8,16", {"--vary", "one size"}},
                       {quality + "--view inside", {"--view", "inside"}},
                       {quality + "--camera nobody --cache @/c", {"nobody", "there are"}},
                       {truth + "-o @/out.exr --spp 0", {"--spp"}},
                       {truth + "-o @/out.exr --noise 0", {"--noise"}},
                       {truth + "-o @/out.exr --spp 4 --noise 0.1", {"--spp", "--noise"}},
                       {truth + "-o @/out.exr --bounces 0", {"--bounces"}},
                       {truth + "-o @/out.exr --bounces some", {"--bounces some"}},
                       {truth + "-o @/out.exr --width 0", {"--width"}},
                       {truth + "-o @/out.exr --view fog", {"--view", "irradiance"}},
                       {truth + "-o @/out.exr --camera none", {"none"}},
                       {truth + "-o @/out.exr --time noon", {"--time"}},
                       {truth + "-o @/out.png", {"--output", ".exr"}},
                   });
}

TEST(HostileCommandLines, OfDevices) {
  const std::vector<std::string> absent = {"99", "'no such thing'", "7:7"};
  for (const std::string& device : absent)
    expect_rejected({device, "--device " + device + " check --stage sizes", 4, {words_of(device).front()}});
  expect_rejected({"below none", "--device=-1 check --stage sizes", 4, {"'-1'"}});
  expect_rejected({"by the environment", "check --stage sizes", 4, {"'99'"}, {}, {}, "CLPV_DEVICE=99"});
  expect_rejected({"no device at all",
                   "check --stage sizes",
                   4,
                   {"no OpenCL device found"},
                   {},
                   {},
                   "OCL_ICD_VENDORS=/nowhere CLPV_DEVICE="});
}

}  // namespace
}  // namespace clpv::test::hostile_command_line_test
