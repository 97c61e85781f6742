// SPDX-License-Identifier: MIT
// Images sent to tev, received by a server of the test.
#include "cli/tev.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <map>
#include <thread>

#include "image/image_io.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace clpv::test::tev_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kSmall = " --width 32 --height 18 --grid 8 --rsm-size 32 --cascades 1";

/// Reads the fields of a packet in order.
class Fields {
 public:
  explicit Fields(const std::vector<char>& bytes) : bytes_(bytes) {}
  template <typename T>
  T number() {
    T value{};
    EXPECT_LE(at_ + sizeof value, bytes_.size());
    if (at_ + sizeof value <= bytes_.size()) std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::string text() {
    std::string value;
    while (at_ < bytes_.size() && bytes_[at_] != 0) value += bytes_[at_++];
    ++at_;
    return value;
  }
  std::vector<std::string> texts() {
    std::vector<std::string> all(static_cast<std::size_t>(number<std::int32_t>()));
    for (std::string& each : all) each = text();
    return all;
  }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  const std::vector<char>& bytes_;
  std::size_t at_ = 0;
};

/// Accepts one connection and keeps its images. Slow and with a small buffer, so that sends are
/// partial.
class Server {
 public:
  /// `packets`: how many are read before the connection is closed.
  explicit Server(int packets = 1 << 30) {
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    const int buffer = 4096;
    setsockopt(listener_, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(listener_, 1), 0);
    socklen_t size = sizeof address;
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
    thread_ = std::thread([this, packets] { serve(packets); });
  }
  ~Server() { finish(); }

  /// Waits until the client has closed the connection.
  void finish() {
    if (!thread_.joinable()) return;
    thread_.join();
    close(listener_);
  }
  std::string option() const { return " --tev=127.0.0.1:" + std::to_string(port); }

  int port = 0, creates = 0, updates = 0, closes = 0;
  std::map<std::string, Image> images;

 private:
  static bool receive(int from, char* to, std::size_t size) {
    for (std::size_t got = 0; got < size;) {
      const ssize_t count = recv(from, to + got, size - got, 0);
      if (count <= 0) return false;
      got += static_cast<std::size_t>(count);
    }
    return true;
  }

  void serve(int packets) {
    const int client = accept(listener_, nullptr, nullptr);
    for (int i = 0; i < packets; ++i) {
      std::uint32_t length = 0;
      if (!receive(client, reinterpret_cast<char*>(&length), sizeof length)) break;
      std::vector<char> bytes(length - sizeof length);
      if (!receive(client, bytes.data(), bytes.size())) break;
      take(Fields(bytes));
    }
    close(client);
  }

  void take(Fields f) {
    const auto type = f.number<std::uint8_t>();
    if (type == 2) {
      ++closes;
      images.erase(f.text());
      return;
    }
    f.number<std::uint8_t>();
    Image& image = images[f.text()];
    if (type == 4) {
      ++creates;
      image.width = f.number<std::int32_t>();
      image.height = f.number<std::int32_t>();
      image.channels = f.texts();
      image.pixels.assign(image.pixel_count() * image.channels.size(), -1);
      EXPECT_EQ(f.left(), 0u);
      return;
    }
    ASSERT_EQ(type, 6);
    ++updates;
    EXPECT_EQ(f.texts(), image.channels);
    const auto x = f.number<std::int32_t>(), y = f.number<std::int32_t>(), width = f.number<std::int32_t>(),
               height = f.number<std::int32_t>();
    const std::size_t channels = image.channels.size();
    std::vector<std::int64_t> offsets(channels), strides(channels);
    for (auto& offset : offsets) offset = f.number<std::int64_t>();
    for (auto& stride : strides) stride = f.number<std::int64_t>();
    std::vector<float> values(f.left() / sizeof(float));
    for (float& value : values) value = f.number<float>();
    for (int j = 0; j < height; ++j) {
      for (int i = 0; i < width; ++i) {
        for (std::size_t c = 0; c < channels; ++c)
          image.at(x + i, y + j, c) =
              values.at(static_cast<std::size_t>(offsets[c] + (j * width + i) * strides[c]));
      }
    }
  }

  int listener_ = -1;
  std::thread thread_;
};

Image ramp(int width, int height, std::vector<std::string> channels) {
  Image image{width, height, std::move(channels), {}, {}, Encoding::linear};
  for (std::size_t i = 0; i < image.pixel_count() * image.channels.size(); ++i)
    image.pixels.push_back(static_cast<float>(i % 1000003));
  return image;
}

TEST(Tev, LargeImagesArriveWhole) {
  Server server;
  const Image large = ramp(2048, 1100, {"R", "G", "B", "A"});  // more than two packets of pixels
  {
    Tev tev("127.0.0.1:" + std::to_string(server.port));
    ASSERT_TRUE(tev.connected());
    tev.show("large", large);
    tev.show("large", large);
    tev.show("small", ramp(3, 2, {"Y"}));
    tev.show("small", ramp(5, 2, {"Y"}));
  }
  server.finish();
  EXPECT_EQ(server.images.at("large").pixels, large.pixels);
  EXPECT_EQ(server.images.at("small").pixels, ramp(5, 2, {"Y"}).pixels);
  EXPECT_EQ(server.creates, 3) << "an image of another size is created again";
  EXPECT_EQ(server.closes, 1);
  EXPECT_GT(server.updates, 4);
}

struct TevCommands : ::testing::Test {
  TemporaryFolder folder;
  Outcome run(const std::string& words) { return run_here(words, folder.path()); }
};

TEST_F(TevCommands, RenderSendsEachView) {
  Server server;
  const Outcome outcome =
      run("render " + kCornell + kSmall + " -o a.exr --view full,depth" + server.option());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  server.finish();
  const Image written = read_image(folder / "a.exr");
  ASSERT_EQ(server.images.size(), 2u);
  const Image& depth = server.images.at("cornell front depth");
  for (int x = 0; x < 32; ++x) EXPECT_EQ(depth.at(x, 9, 0), written.at(x, 9, *written.channel("depth.R")));
}

TEST_F(TevCommands, AViewerThatClosesIsAWarning) {
  Server server(2);
  const Outcome outcome =
      run("sequence " + kCornell + kSmall + " -o frames --frames 8 --fps 1" + server.option());
  server.finish();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("--tev"), HasSubstr("further images are not shown")));
  EXPECT_TRUE(std::filesystem::exists(folder / "frames/frame-0007.exr"));
}

// A full backlog once gave 'Operation now in progress'.
TEST_F(TevCommands, AViewerThatDoesNotAnswerIsAWarning) {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(listener, 0), 0);
  getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  std::vector<int> waiting;
  for (int i = 0; i < 4; ++i) {
    waiting.push_back(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
    static_cast<void>(connect(waiting.back(), reinterpret_cast<sockaddr*>(&address), size));
  }
  const Outcome outcome = run("render " + kCornell + kSmall +
                              " -o a.exr --tev=127.0.0.1:" + std::to_string(ntohs(address.sin_port)));
  for (const int each : waiting) close(each);
  close(listener);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("no answer within 5 s"));
}

TEST_F(TevCommands, BadAddressesAreRejected) {
  for (const char* bad :
       {"host:0", "host:65536", "host:port", ":14158", "a:b:c", "[::1", "[::1]14158", "host:"}) {
    EXPECT_THAT(error_of(ExitCode::usage, [&] { Tev tev(bad); }), HasSubstr("--tev: found")) << bad;
  }
}

}  // namespace
}  // namespace clpv::test::tev_test
