# Pin what was tested: docker build --build-arg BASE=debian:bookworm-slim@sha256:…
ARG BASE=debian:bookworm-slim
FROM ${BASE} AS page
RUN apt-get update && apt-get install -y --no-install-recommends nodejs npm
WORKDIR /page
COPY frontend .
RUN npm ci --no-audit --no-fund && node build.mjs

FROM ${BASE}
LABEL org.opencontainers.image.title="Knitcore" org.opencontainers.image.licenses="MIT"
ENV PIP_NO_CACHE_DIR=1 PYTHONDONTWRITEBYTECODE=1
RUN apt-get update \
 && apt-get install -y --no-install-recommends python3 python3-venv make \
 && rm -rf /var/lib/apt/lists/* \
 && useradd --create-home --uid 10001 knit \
 && mkdir -p /var/lib/knitcore && chown knit:knit /var/lib/knitcore && chmod 700 /var/lib/knitcore
WORKDIR /srv/knitcore
COPY --chown=knit:knit . .
COPY --from=page --chown=knit:knit /page/dist frontend/dist
RUN chown knit:knit /srv/knitcore
USER knit
RUN make install
# Beyond loopback the service asks for a token: docker run -e KNITCORE_TOKEN=… -p 8737:8737
ENV KNITCORE_HOST=0.0.0.0 KNITCORE_PORT=8737 KNITCORE_DATA_DIR=/var/lib/knitcore
VOLUME /var/lib/knitcore
EXPOSE 8737
HEALTHCHECK CMD [".venv/bin/python", "-c", "import urllib.request as u; u.urlopen('http://127.0.0.1:8737/healthz')"]
CMD [".venv/bin/knitcore", "serve"]
