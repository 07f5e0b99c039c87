"""The service: designs, jobs, users and their limits behind a REST API.

The way of a request, from the network down:

1. ``deploy/nginx.conf``, beyond loopback: slow clients, sizes, connections of one address.
2. ``web/observing.py``, ``Observer``: an id, a line in the log, metrics.
3. ``web/security.py``, ``Guard``: host, origin and size; then the user, by token or session, or by
   one of the ``Passes`` where a frame shows a view; then the user's ``RateLimit`` and the requests
   that the user has open (``InUse``).
4. ``web/bodies.py``: the body is counted as it comes. A large one is decoded at a ``Gate``, which
   lets one request through at a time, or left to a worker.
5. ``api``: the route. Light work is done in a thread, behind another ``Gate``.
6. ``compute``: heavy work needs ``ComputingTime`` and waits for a worker; users take ``Turns``.
7. ``web/errors.py``: what was raised on the way becomes a problem (``problems.py``).
"""

from __future__ import annotations

from importlib.metadata import version

VERSION = version("knitcore")
"""Version of the installed program, which ``pyproject.toml`` says."""
