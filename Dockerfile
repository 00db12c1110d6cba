# docker build -t upswing . && docker run --rm -v "$PWD/results:/upswing/results" upswing make smoke
# Another Python: --build-arg PYTHON=3.12 (3.14 needs gcc and libc6-dev besides). An index with torch for a CPU: --build-arg PIP_EXTRA_INDEX_URL=ADDRESS
ARG PYTHON=3.13
FROM python:${PYTHON}-slim-bookworm
ARG PIP_INDEX_URL PIP_EXTRA_INDEX_URL
RUN apt-get update \
    && apt-get install --yes --no-install-recommends git make \
    && rm -rf /var/lib/apt/lists/*
WORKDIR /upswing
# What is installed changes less often than the code, so it has a layer of its own.
COPY Makefile requirements.lock requirements-gpu.lock requirements-slurm.lock ./
RUN PIP_NO_CACHE_DIR=1 make .venv/.locked
COPY . .
RUN make install
CMD ["make", "smoke"]
