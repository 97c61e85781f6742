// SPDX-License-Identifier: MIT
#include "volume/volume.hpp"

#include <climits>
#include <glm/gtc/packing.hpp>

#include "support/error.hpp"

namespace clpv {
namespace {

/// Calls visit(index of the stored number, index in host order) for every coefficient of every
/// cell.
template <typename Visit>
void for_each_number(const VolumeFormat& format, const VolumeShape& shape, Visit visit) {
  std::size_t host = 0;
  for (int channel = 0; channel < shape.channels; ++channel) {
    for (int i = 0; i < shape.coefficients; ++i) {
      for (int z = 0; z < shape.n; ++z) {
        for (int y = 0; y < shape.n; ++y) {
          for (int x = 0; x < shape.n; ++x)
            visit(stored_index(format, shape, channel, i, x, y, z), host++);
        }
      }
    }
  }
}

cl::array<cl::size_type, 3> region(const VolumeShape& shape) {
  const ImageExtent extent = image_extent(shape);
  return {extent.x, extent.y, extent.z};
}

}  // namespace

Volume::Volume(const VolumeShape& shape, const VolumeFormat& format)
    : shape_(shape), format_(format), bytes_(stored_bytes(format, shape)) {}

std::vector<Volume> Volume::array(Session& session, int count, const VolumeShape& shape,
                                  const std::string& what, const VolumeFormat& format) {
  require_supported(session.device(), format, shape);
  std::vector<Volume> volumes(count, Volume(shape, format));
  const std::size_t bits = session.device().handle.getInfo<CL_DEVICE_MEM_BASE_ADDR_ALIGN>(),
                    align = bits / CHAR_BIT, bytes = volumes[0].bytes_,
                    step = (bytes + align - 1) / align * align;
  const Buffer whole = session.buffer(count * step, what);
  for (int i = 0; i < count; ++i) {
    volumes[i].whole_ = whole, volumes[i].from_ = i * step;
    volumes[i].buffer_ = session.part(whole, i * step, bytes);
  }
  volumes.front().clear_to(session, volumes.back());
  return volumes;
}

Volume::Volume(Session& session, const VolumeShape& shape, const std::string& what,
               const VolumeFormat& format)
    : Volume(shape, format) {
  require_supported(session.device(), format, shape);
  if (format.layout == Layout::image) {
    const cl::ImageFormat texel(CL_RGBA,
                                format.storage == Storage::float16 ? CL_HALF_FLOAT : CL_FLOAT);
    image_ = session.image(texel, region(shape), bytes_, what);
  } else {
    buffer_ = session.buffer(bytes_, what);
  }
  clear(session);
}

const cl::Memory& Volume::memory() const {
  if (format_.layout == Layout::image) return image_.handle();
  return buffer_.handle();
}

void Volume::clear(Session& session) {
  if (format_.layout != Layout::image) {
    session.fill_zero(buffer_, bytes_);
    return;
  }
  session.timeline().enqueue([&](cl::Event* event) {
    named_errors([&] {
      session.queue().enqueueFillImage(image_.handle(), cl_float4{{0, 0, 0, 0}}, {0, 0, 0},
                                       region(shape_), nullptr, event);
    });
  });
}

void Volume::clear_to(Session& session, const Volume& last) {
  if (!whole_.exists()) return clear(session);
  session.fill_zero(whole_, last.from_ + last.bytes_ - from_, from_);
}

void Volume::copy_from(Session& session, const Volume& from) {
  if (from.shape_ != shape_ || from.format_ != format_) {
    throw Error(ExitCode::run_time, "cannot copy between volumes of different shapes or formats");
  }
  if (format_.layout != Layout::image) {
    session.copy(from.buffer_, buffer_, bytes_);
    return;
  }
  session.timeline().enqueue([&](cl::Event* event) {
    named_errors([&] {
      session.queue().enqueueCopyImage(from.image_.handle(), image_.handle(), {0, 0, 0}, {0, 0, 0},
                                       region(shape_), nullptr, event);
    });
  });
}

void Volume::read_stored(Session& session, void* numbers) const {
  session.timeline().wait([&] {
    if (format_.layout == Layout::image)
      session.queue().enqueueReadImage(image_.handle(), CL_TRUE, {0, 0, 0}, region(shape_), 0, 0,
                                       numbers);
    else
      session.queue().enqueueReadBuffer(buffer_.handle(), CL_TRUE, 0, bytes_, numbers);
  });
}

void Volume::write_stored(Session& session, const void* numbers) {
  session.timeline().wait([&] {
    if (format_.layout == Layout::image)
      session.queue().enqueueWriteImage(image_.handle(), CL_TRUE, {0, 0, 0}, region(shape_), 0, 0,
                                        numbers);
    else
      session.queue().enqueueWriteBuffer(buffer_.handle(), CL_TRUE, 0, bytes_, numbers);
  });
}

std::vector<float> Volume::read(Session& session) const {
  const std::size_t n = shape_.n;
  std::vector<float> values(n * n * n * shape_.coefficients * shape_.channels);
  const auto take = [&](auto numbers, const auto& widened) {
    read_stored(session, numbers.data());
    for_each_number(format_, shape_,
                    [&](std::size_t from, std::size_t to) { values[to] = widened(numbers[from]); });
  };
  const std::size_t stored = stored_numbers(format_, shape_);
  if (format_.storage == Storage::float16) {
    take(std::vector<std::uint16_t>(stored), glm::unpackHalf1x16);
  } else {
    take(std::vector<float>(stored), [](float number) { return number; });
  }
  return values;
}

void Volume::write(Session& session, const std::vector<float>& values) {
  const auto give = [&](auto numbers, const auto& narrowed) {
    for_each_number(format_, shape_, [&](std::size_t to, std::size_t from) {
      numbers[to] = narrowed(values.at(from));
    });
    write_stored(session, numbers.data());
  };
  const std::size_t stored = stored_numbers(format_, shape_);
  if (format_.storage == Storage::float16) {
    give(std::vector<std::uint16_t>(stored), glm::packHalf1x16);
  } else {
    give(std::vector<float>(stored), [](float number) { return number; });
  }
}

void require_fit(const Volume& volume, const VolumeShape& shape, const VolumeFormat& format,
                 const char* what) {
  if (volume.format() != format) {
    throw Error(ExitCode::run_time, "{}: found a volume of {}, allowed: {}", what,
                format_name(volume.format()), format_name(format));
  }
  const VolumeShape& found = volume.shape();
  if (found != shape) {
    throw Error(ExitCode::run_time,
                "{}: found a volume of {}^3 x {} x {} values, allowed: {}^3 x {} x {}", what,
                found.n, found.coefficients, found.channels, shape.n, shape.coefficients,
                shape.channels);
  }
}

}  // namespace clpv
