# SPDX-License-Identifier: MIT
# clpv on Debian 12 with PoCL, built and installed: docker build -t clpv . && docker run --rm clpv check
# These steps, a check and a frame were run by hand in a bare Debian 12 (debootstrap, chroot with /proc, /sys and /dev; compiler
# cache); not yet tried with Docker.
FROM debian:12.11
COPY . /clpv
WORKDIR /clpv
RUN scripts/setup && cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCLPV_BUILD_TESTS=OFF && \
    cmake --build build && cmake --install build
ENTRYPOINT ["clpv"]
