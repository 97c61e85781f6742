// SPDX-License-Identifier: MIT
// tev's protocol, in little-endian order: a packet is its length (u32, itself included), its type (u8) and its content. Texts end
// with a 0 byte.
//   CreateImage  4: grab focus (u8), name, width, height, number of channels (i32 each), their names
//   UpdateImage  6: grab focus (u8), name, number of channels (i32), their names, x, y, width, height (i32 each),
//                   offset and stride of each channel in the values (i64 each), values (float)
//   CloseImage   2: name
#include "cli/tev.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>

#include "support/error.hpp"
#include "support/log.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kPacketFloats = std::size_t{1} << 22;  // 16 MiB: far below the length's 4 GiB
constexpr timeval kTimeout{5, 0};                            // for a viewer that stopped reading
constexpr std::uint8_t kCloseImage = 2, kCreateImage = 4, kUpdateImage = 6;

class Packet {
 public:
  explicit Packet(std::uint8_t type) { number<std::uint32_t>(0).number(type); }

  template <typename T>
  Packet& number(T value) {
    return raw(&value, sizeof value);
  }
  Packet& text(const std::string& text) { return raw(text.c_str(), text.size() + 1); }
  Packet& texts(const std::vector<std::string>& all) {
    number(static_cast<std::int32_t>(all.size()));
    for (const std::string& each : all) text(each);
    return *this;
  }
  Packet& raw(const void* data, std::size_t size) {
    const auto* from = static_cast<const char*>(data);
    bytes_.insert(bytes_.end(), from, from + size);
    return *this;
  }
  const std::vector<char>& finish() {
    const auto size = static_cast<std::uint32_t>(bytes_.size());
    std::memcpy(bytes_.data(), &size, sizeof size);
    return bytes_;
  }

 private:
  std::vector<char> bytes_;
};

struct HostPort {
  std::string host, port;
};

HostPort parse_address(const std::string& address) {
  const std::string fallback = kTevAddress;
  HostPort found{address, fallback.substr(fallback.find(':') + 1)};
  const bool bracketed = address.starts_with('[');
  const std::size_t end = bracketed ? address.find(']') : std::min(address.find(':'), address.size());
  if (end == std::string::npos || (!bracketed && address.find(':', end + 1) != std::string::npos))
    throw Error(ExitCode::usage, "--tev: found '{}', allowed: HOST, HOST:PORT or [IPv6]:PORT", address);
  found.host = bracketed ? address.substr(1, end - 1) : address.substr(0, end);
  const std::string rest = address.substr(std::min(address.size(), end + (bracketed ? 1 : 0)));
  if (!rest.empty()) found.port = rest.substr(1);
  const auto port = parse_number<int>(found.port);
  if (found.host.empty() || (!rest.empty() && rest[0] != ':') || !port || *port < 1 || *port > 65535)
    throw Error(ExitCode::usage, "--tev: found '{}', allowed: HOST, HOST:PORT or [IPv6]:PORT, port 1..65535",
                address);
  return found;
}

/// Returns a connected socket; a negative one and the reason if there is none.
std::pair<int, std::string> connect_to(const HostPort& to) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* list = nullptr;
  if (const int failed = getaddrinfo(to.host.c_str(), to.port.c_str(), &hints, &list); failed != 0)
    return {-1, gai_strerror(failed)};
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(list, &freeaddrinfo);
  std::string reason = "no address";
  for (const addrinfo* each = list; each != nullptr; each = each->ai_next) {
    const int made = socket(each->ai_family, each->ai_socktype | SOCK_CLOEXEC, each->ai_protocol);
    if (made < 0) continue;
    setsockopt(made, SOL_SOCKET, SO_SNDTIMEO, &kTimeout, sizeof kTimeout);  // of connect() too
    if (connect(made, each->ai_addr, each->ai_addrlen) == 0) return {made, ""};
    // The time-out of a connection is EINPROGRESS.
    reason =
        errno == EINPROGRESS ? fmt::format("no answer within {} s", kTimeout.tv_sec) : std::strerror(errno);
    ::close(made);
  }
  return {-1, reason};
}

}  // namespace

Tev::Tev(const std::string& address) : address_(address) {
  const auto [socket, reason] = connect_to(parse_address(address));
  socket_ = socket;
  if (!connected()) spdlog::warn("--tev {}: {}; is tev running? Images are not shown", address_, reason);
}

Tev::~Tev() {
  if (connected()) ::close(socket_);
}

void Tev::close(const std::string& reason) {
  spdlog::warn("--tev {}: {}; further images are not shown", address_, reason);
  ::close(socket_);
  socket_ = -1;
}

void Tev::send(const std::vector<char>& packet) {
  std::size_t sent = 0;
  while (connected() && sent < packet.size()) {
    const ssize_t count = ::send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
    if (count > 0) {
      sent += static_cast<std::size_t>(count);  // may be a part
    } else if (errno != EINTR) {
      close(errno == EAGAIN ? "tev stopped reading" : std::strerror(errno));
    }
  }
}

void Tev::show(const std::string& name, const Image& image) {
  if (!connected()) return;
  const Shown now{name, image.width, image.height, image.channels};
  const auto before = std::ranges::find(shown_, name, &Shown::name);
  if (before == shown_.end() || *before != now) {
    if (before != shown_.end()) {
      send(Packet(kCloseImage).text(name).finish());
      shown_.erase(before);
    }
    send(Packet(kCreateImage)
             .number<std::uint8_t>(1)
             .text(name)
             .number<std::int32_t>(image.width)
             .number<std::int32_t>(image.height)
             .texts(image.channels)
             .finish());
    shown_.push_back(now);
  }
  const std::size_t row = static_cast<std::size_t>(image.width) * image.channels.size();
  const int rows = static_cast<int>(std::max<std::size_t>(1, kPacketFloats / row));
  for (int y = 0; y < image.height; y += rows) {
    const int height = std::min(rows, image.height - y);
    Packet packet(kUpdateImage);
    packet.number<std::uint8_t>(0).text(name).texts(image.channels);
    for (const std::int32_t number : {0, y, image.width, height}) packet.number(number);
    for (std::size_t c = 0; c < image.channels.size(); ++c) packet.number(static_cast<std::int64_t>(c));
    for (std::size_t c = 0; c < image.channels.size(); ++c)
      packet.number(static_cast<std::int64_t>(image.channels.size()));
    packet.raw(image.pixels.data() + static_cast<std::size_t>(y) * row,
               static_cast<std::size_t>(height) * row * sizeof(float));
    send(packet.finish());
  }
}

std::string tev_name(const SceneData& scene, const SceneCamera& camera, Show view) {
  return fmt::format("{} {} {}", scene.name, camera.name, name_of(view));
}

void add_tev(CLI::App& command, std::string& address) {
  command
      .add_option_function<std::string>(
          "--tev", [&address](const std::string& given) { address = given; },
          fmt::format("send images to the viewer tev while they are computed (default address: {})",
                      kTevAddress))
      ->type_name("[HOST[:PORT]]")
      ->default_str(kTevAddress)
      ->expected(0, 1);
}

}  // namespace clpv
