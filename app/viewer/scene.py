"""The scene of a fabric in viser: yarn, rectangles, a mark."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.draw.instances import level_of

from ..drawing.colours import SKIN
from ..drawing.fabric import Box, Drawing, FabricScene, Ground
from .camera import ASPECT, Cameras, CameraSide
from .cloth import UNITS_PER_MM, ShownStitches

if TYPE_CHECKING:
    import viser

Colour = tuple[int, int, int]

STILL_S = 0.4
"""Tubes that a stretch has flattened are drawn again after this time without another change."""
REFRAMED = 0.05
"""Change of a cloth's size, as a logarithm, from which on it is framed again."""
MARK = (232, 72, 44)
INK = (30, 30, 30)
SCALE = (128, 120, 112)
"""Colour of the scale, which shows on light and on dark ground."""
SCALE_BELOW = (1.8, 0.075)
"""The scale lies this many stitches below the fabric, and this share of what is framed at least:
its words have the same size on the screen from near and from afar."""
WORDS_BELOW = 1.3
"""Room below the fabric for the scale with its words, over how far the scale lies below it."""
PAPER = (255, 252, 246)
UNSHADED: dict[str, Any] = {"cast_shadow": False, "receive_shadow": False}
SHEETS = {"face": ((0.0, 1.0, 0.0, 0.0), 0.0), "back": ((0.0, 0.0, 0.0, 1.0), 0.2)}
"""Rotation, and depth below the middle plane over the yarn's height, of pictures of a cloth. viser
has the top of a picture at its lowest y, as cameras do."""
COARSE_WINDOW = 10_000
"""Stitches drawn as yarn without a GPU, of a chart that is too large to be drawn whole."""


class SceneWriter:
    """Keeps one viser server's scene in step with a :class:`Drawing`.

    Attributes
    ----------
    coarse : whether what is drawn from now on is for browsers without a GPU, too.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._lock = threading.RLock()
        self._drawing: Drawing | None = None
        self._cloth = ShownStitches(server)
        self._timer: threading.Timer | None = None
        self._layers: dict[str, Any] = {}
        self._framed: tuple[tuple[int, int], Array] | None = None
        self._cameras = Cameras(server)
        self._side = CameraSide.FACE
        self.coarse = self._laid_coarse = False

    @property
    def drawing(self) -> Drawing | None:
        """The fabric shown."""
        return self._drawing

    def write(self, drawing: Drawing, face: bytes | None = None) -> int:
        """Show a fabric to everybody who looks; returns the number of stitches drawn as yarn.

        Parameters
        ----------
        face : picture of a cloth of many stitches, for the eye that is far away; a PNG.
        """
        part, ground = drawing.part, drawing.ground
        with self._lock, self._server.atomic():  # no scale, nor frame, of the cloth before
            self._drawing = drawing
            stitches = self._lay(exact=not self._server.get_clients())
            self._draw_rectangles(part, ground.middle_mm)
            self._draw_body(part, ground.middle_mm)
            self._draw_sheet("face", ground, face)
            if face is None:  # the back that is there is replaced by the next
                self._draw_sheet("back", ground, None)
            self._draw_scale(ground)
            self._frame(ground)
        return stitches

    def mark(self, box: Box | None) -> None:
        """Outline some stitches on both sides, or none."""
        with self._lock:
            ground = self._drawing.ground if self._drawing is not None else None
            if box is None or ground is None or not ground.is_flat:
                self._put("mark", None)
                return
            sides, top = ground.outline_mm(box), ground.top_mm
            ends = [np.insert(sides, 2, z, axis=2) for z in (top, -top)]
            self._put_lines("mark", _units(np.concatenate(ends)), MARK, 3.0)

    def look(self, side: CameraSide) -> None:
        """Turn everybody's camera to a side."""
        with self._lock:
            self._side = side
            self._place_camera(everybody=True)

    def fit(self, client: viser.ClientHandle) -> None:
        """Let a camera that nobody has turned see the whole fabric in a view of its shape."""
        with self._lock:
            self._cameras.place(client)

    def redraw(self) -> None:
        """Draw the same again if it should be finer or coarser now."""
        if self._laid_coarse != self.coarse:
            self._lay(exact=True)

    def close(self) -> None:
        """Draw nothing any more, and forget what was drawn."""
        with self._lock:
            self._drawing = None
            self._stop_timer()

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _lay(self, *, exact: bool) -> int:
        """Lay the stitches, and if they are flattened, once more when they keep still."""
        with self._lock:
            self._stop_timer()
            if self._drawing is None:
                return 0
            part, self._laid_coarse = self._drawing.part, self.coarse
            if self.coarse and not self._drawing.is_whole:
                part = part.window(COARSE_WINDOW)
            stitches = int(part.shapes.index.size if part.drawn is None else part.drawn.sum())
            middle = self._drawing.ground.middle_mm
            level = level_of(stitches, coarse=self.coarse)
            if self._cloth.lay(part, middle, level, exact=exact):
                self._timer = threading.Timer(STILL_S, self._lay, kwargs={"exact": True})
                self._timer.daemon = True
                self._timer.start()
            return stitches

    def _frame(self, ground: Ground) -> None:
        """Place the cameras again that nobody has turned, where a cloth is of another size."""
        size = ground.framed_mm
        if self._framed is not None and self._framed[0] == ground.shape:
            change = np.abs(np.log(size / self._framed[1]))
            if change.max() < REFRAMED:
                return
        self._framed = ground.shape, size
        self._place_camera(everybody=False)

    def _place_camera(self, *, everybody: bool) -> None:
        if self._drawing is None:
            return
        ground = self._drawing.ground
        extent = UNITS_PER_MM * ground.framed_mm
        below = UNITS_PER_MM * WORDS_BELOW * _scale_below_mm(ground)
        self._cameras.aim(self._side, extent, below, everybody=everybody)

    # -- layers -------------------------------------------------------------------------------

    def _draw_rectangles(self, scene: FabricScene, middle: Array) -> None:
        if scene.rectangles_mm is None:
            self._put("rectangles", None)
            self._put("panes", None)
            return
        highest = scene.placement.depth * scene.shapes.lines[..., 2].max()
        height = highest + 1.3 * scene.shapes.yarn_radius_mm
        flat = scene.rectangles_mm - middle
        corners = _units(np.concatenate([flat, np.full((*flat.shape[:2], 1), height)], axis=2))
        first = 4 * np.arange(len(corners))[:, None]
        faces = (first + np.array([0, 1, 2, 0, 2, 3])).reshape(-1, 3).astype(np.uint32)
        self._put_mesh("panes", corners.reshape(-1, 3), faces, PAPER, opacity=0.55)
        lines = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2, 3)
        self._put_lines("rectangles", lines, INK, 1.5)

    def _draw_body(self, scene: FabricScene, middle: Array) -> None:
        if scene.body is None:
            self._put("body", None)
            return
        vertices = _units(scene.body.sunk_mm(scene.top_mm) - np.append(middle, 0.0))
        self._put_mesh("body", vertices, scene.body.faces, SKIN)

    def show_back(self, drawing: Drawing, picture: bytes | None) -> None:
        """Show the picture of a cloth's back, unless the cloth was changed meanwhile."""
        with self._lock:
            if drawing is self._drawing:
                self._draw_sheet("back", drawing.ground, picture)

    def _draw_sheet(self, side: str, ground: Ground, picture: bytes | None) -> None:
        """A picture of the cloth in its middle plane; browsers show it from afar
        (frontend/viser/yarn.js)."""
        if picture is None:
            self._put(side, None)
            return
        turned, depth = SHEETS[side]
        width, height = UNITS_PER_MM * ground.reach_mm
        packed: Any = picture  # see app.viewer.private_port
        image = self._server.scene.add_image(
            f"/{side}", packed, float(width), float(height), wxyz=turned,
            position=(0.0, 0.0, -depth * UNITS_PER_MM * ground.top_mm), **UNSHADED,
        )  # fmt: skip
        self._put(side, image)

    def _draw_scale(self, ground: Ground) -> None:
        """A line of round length below the fabric, at its right."""
        width, height = ground.extent_mm
        length = round_length_mm(width, height)
        right, below = float(width) / 2, -float(height) / 2 - _scale_below_mm(ground)
        tick = 0.06 * length
        points = np.array(
            [
                [[right - length, below, 0.0], [right, below, 0.0]],
                [[right - length, below - tick, 0.0], [right - length, below + tick, 0.0]],
                [[right, below - tick, 0.0], [right, below + tick, 0.0]],
            ]
        )
        self._put_lines("scale", _units(points), SCALE, 2.0)
        words = f"{length:g} mm" if length < 10 else f"{length / 10:g} cm"
        beside = UNITS_PER_MM * np.array([right - length - tick, below, 0.0])
        self._put(
            "scale words",
            self._server.scene.add_label(
                "/scale/words", words, position=tuple(beside), anchor="center-right"
            ),
        )

    def _put_lines(
        self, name: str, points: NDArray[np.float32], colour: Colour, thickness: float
    ) -> None:
        lines = self._server.scene.add_line_segments(
            f"/{name}", points, colour, thickness=thickness, thickness_units="screen"
        )
        self._put(name, lines)

    def _put_mesh(
        self,
        name: str,
        vertices: NDArray[np.float32],
        faces: NDArray[np.uint32],
        colour: Colour,
        **more: Any,
    ) -> None:
        mesh = self._server.scene.add_mesh_simple(
            f"/{name}", vertices, faces, color=colour, side="double", **UNSHADED, **more
        )
        self._put(name, mesh)

    def _put(self, name: str, handle: Any) -> None:
        """Note a layer's new handle; the same name replaced the old one, None removes it."""
        old = self._layers.pop(name, None)
        if handle is not None:
            self._layers[name] = handle
        elif old is not None:
            old.remove()


def round_length_mm(width_mm: float, height_mm: float) -> float:
    """1, 2 or 5 times a power of ten, about a fifth of the longer side of a cloth.

    Examples
    --------
    >>> round_length_mm(106.0, 40.0), round_length_mm(40.0, 520.0), round_length_mm(9.0, 9.0)
    (20.0, 100.0, 1.0)
    """
    length = max(width_mm, height_mm) / 5
    power = 10.0 ** np.floor(np.log10(length))
    return float(power * max(step for step in (1, 2, 5) if power * step <= length * (1 + 1e-9)))


def _scale_below_mm(ground: Ground) -> float:
    """How far the scale lies below a fabric; its lowest loops reach below its own edge, the farther
    the more they are stretched.
    """
    stitch = float(ground.sizes_mm[..., 1].max())
    width, height = map(float, ground.framed_mm)
    return max(SCALE_BELOW[0] * stitch, SCALE_BELOW[1] * max(height, width / ASPECT))


def _units(points_mm: Array) -> NDArray[np.float32]:
    """Places of the fabric in the scene's unit."""
    return (UNITS_PER_MM * points_mm).astype(np.float32)
