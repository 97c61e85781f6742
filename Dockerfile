# SPDX-License-Identifier: MIT
# clpv on Debian 12 with PoCL, built and installed: docker build -t clpv . && docker run --rm clpv check
# Untested: there was no Docker where it was written; each line is a script's or CMake's that is tested.
FROM debian:12
COPY . /clpv
WORKDIR /clpv
RUN scripts/setup && scripts/build && cmake --install build
ENTRYPOINT ["clpv"]
