// Presets: named sets of render options (--preset). Single options override what they set.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace clpv {

struct RenderOptions;

struct Preset {
  std::string name;
  std::string help;
  std::vector<std::pair<std::string, std::string>> options;  ///< long name and value; all others: the default
};

/// `best`, which is the defaults, and `paper`, the published scheme.
const std::vector<Preset>& presets();
std::vector<std::string> preset_names();

/// Gives every option that some preset sets its value in this one (else its default); the others, such as
/// the image's size, stay as they are. Throws Error(usage) that lists the presets there are.
void apply_preset(RenderOptions& options, std::string_view name);

}  // namespace clpv
