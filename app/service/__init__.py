"""The service: designs, jobs, users and their limits behind a REST API.

The way of a request, from the network down:

1. ``deploy/nginx.conf``, beyond loopback: slow clients, sizes, connections of one address.
2. ``web/observing.py``, ``Observer``: an id, a line in the log, metrics.
3. ``web/security.py``, ``AccessControl``: host, origin and size; then the user, by token or
   session, or by one of the ``ViewPasses`` where a frame shows a view; then the user's
   ``RateLimit``, and the requests that the user has open (``ConcurrencyLimit``).
4. ``web/bodies.py``: the body is counted as it comes. A large one is decoded under a ``FairLock``,
   one at a time, or left to a worker.
5. ``api``: the route. Light work is done in a thread, under another ``FairLock``.
6. ``compute``: heavy work is within the user's ``CpuTimeLimit`` and waits for a worker in a
   ``FairQueue``.
7. ``web/errors.py``: what was raised on the way becomes a problem (``problems.py``).
"""

from importlib.metadata import version

VERSION = version("knitcore")
"""Version of the installed program, which ``pyproject.toml`` says."""
