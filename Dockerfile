# `scripts/image pin` writes the digests of today's images; `scripts/image` builds this and tries it out.
ARG BASE=debian:bookworm-slim@sha256:88200866dfff7ea7f5cbcb6ec7c8a701889efe6fe859fe64d6990e4b07ea4171

FROM ${BASE} AS page
RUN apt-get update \
 && apt-get install -y --no-install-recommends nodejs npm python3 \
 && rm -rf /var/lib/apt/lists/*
WORKDIR /page
COPY knitcore knitcore
COPY scripts/page_stitches.py scripts/
COPY frontend frontend
RUN PYTHONPATH=. python3 scripts/page_stitches.py && cd frontend && npm ci --no-audit --no-fund && node build.mjs

FROM ${BASE} AS program
ENV PIP_NO_CACHE_DIR=1 PIP_DISABLE_PIP_VERSION_CHECK=1
RUN apt-get update \
 && apt-get install -y --no-install-recommends python3 python3-venv \
 && rm -rf /var/lib/apt/lists/*
WORKDIR /src
COPY requirements.lock .
RUN python3 -m venv /opt/knitcore \
 && sed '/^# --- installer/,$d' requirements.lock >product.txt \
 && /opt/knitcore/bin/pip install --require-hashes -r product.txt
COPY . .
COPY --from=page /page/frontend/dist frontend/dist
RUN /opt/knitcore/bin/pip install --no-deps . \
 && find /opt/knitcore -type d '(' -name tests -o -path '*/site-packages/docs' ')' -prune -exec rm -rf {} + \
 && /opt/knitcore/bin/pip uninstall -y pip

FROM ${BASE} AS proxy
RUN apt-get update \
 && apt-get install -y --no-install-recommends nginx-light \
 && rm -rf /var/lib/apt/lists/*
COPY deploy/nginx.conf /etc/nginx/nginx.conf

FROM ${BASE}
LABEL org.opencontainers.image.title="Knitcore" org.opencontainers.image.licenses="MIT"
RUN apt-get update \
 && apt-get install -y --no-install-recommends python3 \
 && rm -rf /var/lib/apt/lists/* \
 && useradd --no-create-home --uid 10001 knit \
 && mkdir -p /var/lib/knitcore && chown knit:knit /var/lib/knitcore && chmod 700 /var/lib/knitcore
COPY --from=program /opt/knitcore /opt/knitcore
USER knit
# Beyond loopback the service asks for a token: docker run -v /a/folder:/run/secrets:ro -p 8737:8737
# where the folder has a file knitcore_token.
ENV PATH=/opt/knitcore/bin:$PATH PYTHONDONTWRITEBYTECODE=1 NUMBA_CACHE_DIR=/tmp/numba \
    KNITCORE_HOST=0.0.0.0 KNITCORE_PORT=8737 KNITCORE_DATA_DIR=/var/lib/knitcore
VOLUME /var/lib/knitcore
EXPOSE 8737
HEALTHCHECK CMD ["python", "-c", "import os, urllib.request as u; u.urlopen(f\"http://127.0.0.1:{os.environ['KNITCORE_PORT']}/healthz\")"]
CMD ["knitcore", "serve"]
