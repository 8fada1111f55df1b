# docker build -t active-chainmail .
# docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/work" active-chainmail run single_coil_heating
# x86-64 on every machine: there alone pybullet has a wheel for Python 3.11, and requirements.lock was resolved for it.
FROM --platform=linux/amd64 python:3.11-slim-bookworm AS build
RUN apt-get update && apt-get install -y --no-install-recommends gcc libc6-dev && rm -rf /var/lib/apt/lists/*
COPY . /source
RUN python -m venv /opt/cosim \
 && /opt/cosim/bin/pip install --no-cache-dir --require-hashes -r /source/requirements.lock \
 && /opt/cosim/bin/pip install --no-cache-dir --no-deps --no-build-isolation /source

FROM --platform=linux/amd64 python:3.11-slim-bookworm
# gcc builds the FMUs of the shipped actuators at their first use, and those that users write.
RUN apt-get update && apt-get install -y --no-install-recommends gcc libc6-dev libngspice0 \
 && rm -rf /var/lib/apt/lists/*
COPY --from=build /opt/cosim /opt/cosim
# With `--user` the home folder is `/`, which cannot be written; Matplotlib would keep its settings there.
ENV OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 PATH=/opt/cosim/bin:$PATH \
    XDG_CACHE_HOME=/var/cache/cosim MPLCONFIGDIR=/var/cache/cosim/matplotlib
# Built now, so that a container without a writable cache can run every scenario.
RUN cosim compare single_coil_heating --set "time.stop=1 s" --out /tmp/once --jobs 1 && rm -r /tmp/once \
 && chmod -R a+rwX /var/cache/cosim
WORKDIR /work
ENTRYPOINT ["cosim"]
CMD ["--help"]
