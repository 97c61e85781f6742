# SPDX-License-Identifier: MIT
# clpv on Debian 12 with PoCL, built and installed: docker build -t clpv . && docker run --rm clpv check
# Untested with Docker; tests cover the scripts and CMake commands in it.
FROM debian:12
COPY . /clpv
WORKDIR /clpv
RUN scripts/setup && scripts/build && cmake --install build
ENTRYPOINT ["clpv"]
