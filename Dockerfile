# eomgen in a container, with a compiler and the runtime for emitted code:
#   docker build -t eomgen .
#   docker run --rm -v "$PWD:/work" --user "$(id -u):$(id -g)" eomgen run model.toml
FROM debian:bookworm AS build
RUN apt-get update && apt-get install -y --no-install-recommends dpkg-dev file
COPY . /source
WORKDIR /source
RUN scripts/setup
RUN cmake --preset release -DEOMGEN_BUILD_TESTS=OFF -DEOMGEN_UNITY=ON && cmake --build --preset release
RUN cd build/release && cpack -G DEB -B /package

FROM debian:bookworm-slim
COPY --from=build /package/*.deb /package/
RUN apt-get update \
 && apt-get install -y --no-install-recommends /package/*.deb gcc g++ libc6-dev libeigen3-dev \
 && rm -rf /package /var/lib/apt/lists/*
ENV EOMGEN_CACHE_DIR=/tmp/eomgen XDG_CACHE_HOME=/tmp
WORKDIR /work
ENTRYPOINT ["eomgen"]
CMD ["--help"]
