// SPDX-License-Identifier: MIT
// Sends images to tev, a viewer for high dynamic range images (https://github.com/Tom94/tev), through its network protocol.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "cli/options.hpp"
#include "clpv/image.hpp"
#include "options/show.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// A connection to tev. Failures are warnings: rendering goes on without the viewer.
class Tev {
 public:
  /// `address`: HOST, HOST:PORT, or [IPv6]:PORT. Throws Error(usage) for a malformed address; warns if nothing listens there.
  explicit Tev(const std::string& address);
  ~Tev();
  Tev(const Tev&) = delete;
  Tev& operator=(const Tev&) = delete;

  /// Shows the image under that name: creates it there, or replaces its pixels if its size and channels are the same.
  void show(const std::string& name, const Image& image);

  bool connected() const { return socket_ >= 0; }

 private:
  void send(const std::vector<char>& packet);
  void close(const std::string& reason);

  std::string address_;
  int socket_ = -1;
  struct Shown {
    std::string name;
    int width, height;
    std::vector<std::string> channels;
    bool operator==(const Shown&) const = default;
  };
  std::vector<Shown> shown_;
};

inline constexpr const char* kTevAddress = "127.0.0.1:14158";

/// Name of an image in tev: scene, camera and view.
std::string tev_name(const SceneData& scene, const SceneCamera& camera, Show view);

/// Adds --tev [HOST[:PORT]]; `address` is empty without it.
void add_tev(CLI::App& command, std::string& address);

}  // namespace clpv
