# SPDX-License-Identifier: MIT
# clpv on Debian 12 with PoCL, built and installed: docker build -t clpv . && docker run --rm clpv check
# Not built by the tests, which cover its parts: scripts/setup, scripts/build, and `cmake --install` (package.consumer).
FROM debian:12
COPY . /clpv
WORKDIR /clpv
RUN scripts/setup && scripts/build && cmake --install build
ENTRYPOINT ["clpv"]
