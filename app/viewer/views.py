"""One private viser server per open design, closed when it is not watched for a while."""

from __future__ import annotations

import logging
import threading
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ..drawing.fabric import Drawing, Ground
from ..service.limits.user_limits import USER_LIMITS, OverLimitError
from ..service.listeners import Listeners
from ..service.problems import ServiceError, UnavailableError
from .camera import FARTHEST
from .cloth import UNITS_PER_MM
from .incoming import WantedPicture
from .scene import SceneWriter

if TYPE_CHECKING:
    import viser

log = logging.getLogger("knitcore.app")
Cell = tuple[int, int]


@dataclass
class View:
    """A design's viser server; it listens on loopback only and is reached through the relay.

    Attributes
    ----------
    watchers, coarse : browsers that show it, and those of them that draw without a GPU.
    picture : the picture that a browser was asked for, if one was.
    picturing : held by who takes a picture.
    stitches : of the chart it shows; memory grows with them.
    """

    server: viser.ViserServer
    writer: SceneWriter
    watchers: int = 0
    coarse: int = 0
    picture: WantedPicture | None = None
    picturing: threading.Lock = field(default_factory=threading.Lock)
    last_used: float = field(default_factory=time.monotonic)
    stitches: int = 0

    @property
    def port(self) -> int:
        """Loopback port of the viser server."""
        return int(self.server.get_port())

    def show(self, drawing: Drawing, face: bytes | None = None) -> int:
        """Draw a fabric; returns the number of stitches drawn as yarn."""
        self.last_used = time.monotonic()
        return self.writer.write(drawing, face)

    def stop(self) -> None:
        """Close its server.

        The scene is freed at once; Python may keep the rest, objects that refer to each other.
        """
        self.writer.close()
        self.server.scene.reset()
        self.server.stop()


class Views:
    """The open views by design.

    Views are disposable: the scene is rebuilt from the design when it is opened again.

    Parameters
    ----------
    most : how many are kept at once; the longest unwatched one makes room.
    idle_s : how long an unwatched view is kept.
    """

    def __init__(self, most: int, idle_s: float) -> None:
        self.clicks = Listeners[Cell]()
        self._most = most
        self._idle_s = idle_s
        self._views: dict[str, View] = {}
        self._coarse: dict[str, bool] = {}  # of each user's last browser, for the next view
        self._lock = threading.Lock()  # the event loop waits for it: held for a moment only
        self._opening = threading.Lock()  # held while a view is made or closed for another

    def open(self, design: str, stitches: int = 0) -> View:
        """The design's view, made if it is not there; its name begins with its owner's.

        Parameters
        ----------
        stitches : of the chart that it is going to show.

        Raises
        ------
        OverLimitError
            If the owner watches as many, or as many stitches, as one user may.
        UnavailableError
            If as many views as allowed are being watched.
        """
        with self._opening:
            self._make_room(design, stitches)
            view = self._kept(design, stitches)
            if view is None:
                view = new_view()
                view.writer.coarse = self._coarse.get(_owner(design), False)
                view.stitches = stitches
                self._pass_clicks_on(design, view)
                with self._lock:
                    self._views[design] = view
            return view

    def _kept(self, design: str, stitches: int) -> View | None:
        """The design's view, if it is open, which from now on shows so many stitches."""
        with self._lock:
            view = self._views.get(design)
            if view is not None:
                view.last_used, view.stitches = time.monotonic(), stitches
            return view

    def get(self, design: str) -> View | None:
        """The design's view, if it is open."""
        return self._views.get(design)

    def watch(self, design: str, change: int, *, coarse: bool = False) -> None:
        """Count a watcher in (+1) or out (-1); for one without a GPU the view draws coarsely."""
        with self._lock:
            view = self._views.get(design)
            if view is not None:
                view.watchers += change
                view.coarse += coarse * change
                view.writer.coarse = view.coarse > 0
                if change > 0:
                    self._coarse[_owner(design)] = coarse
                view.last_used = time.monotonic()

    def close_idle(self) -> int:
        """Close views that have not been watched for a while; returns their number."""
        deadline = time.monotonic() - self._idle_s
        with self._lock:
            idle = [d for d, v in self._views.items() if not v.watchers and v.last_used < deadline]
            stopped = [self._views.pop(design) for design in idle]
        for view in stopped:
            view.stop()
        return len(stopped)

    def close(self) -> None:
        """Close all views, and one that is being made once it is."""
        with self._opening, self._lock:
            views = list(self._views.values())
            self._views.clear()
        for view in views:
            view.stop()

    def __len__(self) -> int:
        return len(self._views)

    def count(self, owner: str) -> int:
        """Number of open views of a user."""
        return len(self._of(owner))

    def stitches(self, owner: str) -> int:
        """Stitches of a user's views together, a rectangle counted as 20."""
        return self._stitches_of(self._of(owner))

    def _stitches_of(self, designs: list[str]) -> int:
        return sum(view.stitches for view in map(self.get, designs) if view is not None)

    def _of(self, owner: str) -> list[str]:
        return [design for design in list(self._views) if _owner(design) == owner]

    def _pass_clicks_on(self, design: str, view: View) -> None:
        @view.server.scene.on_click()
        def clicked(event: viser.SceneClickEvent) -> None:
            drawing = view.writer.drawing
            if drawing is None:
                return
            x, y, z = (value / UNITS_PER_MM for value in event.ray_origin)
            cell = clicked_stitch(drawing.ground, (x, y, z), event.ray_direction)
            if cell is not None:
                self.clicks.tell(design, cell)

    def _make_room(self, design: str, stitches: int) -> None:
        others = [view for view in self._of(_owner(design)) if view != design]
        while (held := self._stitches_of(others)) and (held + stitches > USER_LIMITS.view_stitches):
            refusal = OverLimitError.of("view_stitches", held, USER_LIMITS.view_stitches)
            others.remove(self._close_oldest(others, refusal))
        if design in self._views:
            return
        if len(others) >= USER_LIMITS.views:
            self._close_oldest(others, OverLimitError.of("views", len(others), USER_LIMITS.views))
        if len(self._views) >= self._most:
            full = UnavailableError(f"All {self._most} 3D views are in use.")
            self._close_oldest(list(self._views), full)

    def _close_oldest(self, among: list[str], refusal: ServiceError) -> str:
        with self._lock:
            open_ones = ((view, d) for d in among if (view := self._views.get(d)))
            unwatched = [(view.last_used, d) for view, d in open_ones if not view.watchers]
            if not unwatched:
                raise refusal
            oldest = min(unwatched)[1]
            closed = self._views.pop(oldest)
        closed.stop()
        return oldest


def _owner(design: str) -> str:
    return design.rpartition("/")[0]


def new_view() -> View:
    """An empty view, with a server of its own."""
    from .private_port import private_server  # viser loads for 0.2 s

    server = private_server()
    server.gui.configure_theme(show_logo=False, show_share_button=False)
    scene = server.scene
    scene.set_up_direction("+y")
    scene.world_axes.visible = False
    # Light from the upper left, as charts and maps have it; soft enough to keep colours true.
    scene.configure_environment_map(hdri=None)
    scene.configure_default_lights(enabled=False)
    scene.add_light_hemisphere(
        "/light/sky", sky_color=(255, 252, 246), ground_color=(120, 112, 108), intensity=1.35
    )
    scene.add_light_directional("/light/key", intensity=2.6, position=(-70.0, 100.0, 90.0))
    scene.add_light_directional("/light/back", intensity=2.6, position=(70.0, 100.0, -90.0))

    writer = SceneWriter(server)

    @server.on_client_connect
    def stay_in_sight(client: viser.ClientHandle) -> None:
        client.camera.max_orbit_distance = FARTHEST
        client.camera.on_update(lambda _: writer.fit(client))
        writer.fit(client)  # it may have begun where cameras no longer do

    return View(server, writer)


def clicked_stitch(
    ground: Ground, origin: tuple[float, float, float], direction: tuple[float, float, float]
) -> Cell | None:
    """The stitch where a ray meets the fabric's middle plane; None outside the fabric.

    Tubes are thin and often missed, the plane never is.
    """
    if abs(direction[2]) < 1e-6:
        return None
    along = -origin[2] / direction[2]
    if along < 0:
        return None
    return ground.stitch_at(origin[0] + along * direction[0], origin[1] + along * direction[1])
