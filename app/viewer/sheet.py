"""Cloth from afar: pictures of its face and of its back, in which every stitch is drawn."""

import io
import math
from collections.abc import Callable

import numpy as np
import scipy
from PIL import Image, ImageFilter

from knitcore.draw.body import Floats
from knitcore.draw.placing import mean_sizes_mm
from knitcore.draw.tubes import resampled

from ..context import Supplies
from ..drawing.colours import linear
from ..drawing.computed import PosedView, StretchView
from ..drawing.design_view import ViewRequest, build_scene
from ..drawing.fabric import Drawing, FabricScene
from .balls import Balls, Picture, drawn, points_along

PIXELS = 2_000_000
LONGEST = 4096
"""Pixels of a picture, and of its longer side, at most."""
STITCH = 10.0
"""Width of a stitch at most, pixels."""
GAP = 0.3
"""Light in the gaps between loops, over that of the yarn around them."""
PARTS = 4
"""A row is a whole number of such parts of a pixel high. Rows of any height would fall in step with
pixels and out of it again over many rows, and garter would have bands."""
AROUND = 8
"""Width of the squares of pixels whose mean light is that of the yarn around."""
CLOSED = 5
"""Half of the width up to which a gap has shade in it, pixels: it is cloth, not a hole."""
SOFT = 0.9
"""Standard deviation in pixels by which a picture is blurred, or loops and pixels would beat."""
QUALITY = 90
"""Quality of pictures on their way to browsers, 0 to 100."""
FEWEST = 900
"""Stitches of a flat cloth that is seen from so far that its loops make one surface."""


def looks_even(scene: FabricScene) -> bool:
    """Tell whether loops of a cloth are too small in a view to be seen one by one."""
    return scene.placement.frames is None and scene.shapes.index.size >= FEWEST


def build_drawing(
    request: ViewRequest, supplies: Supplies, *, cancelled: Callable[[], bool]
) -> tuple[Drawing, bytes | None]:
    """Draw a large chart, which has no stretch test or shape, and its face; runs in a worker."""
    scene = build_scene(request, None, supplies.context(cancelled=cancelled))
    return scene.drawing(), packed_sheet(scene)


def build_back(
    request: ViewRequest,
    computed: StretchView | PosedView | None,
    supplies: Supplies,
    *,
    cancelled: Callable[[], bool],
) -> bytes | None:
    """Draw the back of a design; runs in a worker."""
    scene = build_scene(request, computed, supplies.context(cancelled=cancelled))
    return packed_sheet(scene, back=True)


def packed_sheet(scene: FabricScene, *, back: bool = False) -> bytes | None:
    """The :func:`sheet_picture` as a file for browsers."""
    picture = sheet_picture(scene, back=back)
    return None if picture is None else packed(picture)


def packed(picture: Picture) -> bytes:
    """A picture as a WebP: a seventh of a PNG, in half the time, and other threads go on."""
    file = io.BytesIO()
    Image.fromarray(picture, "RGBA").save(file, "WEBP", quality=QUALITY, method=0)
    return file.getvalue()


def sheet_picture(scene: FabricScene, *, back: bool = False) -> Picture | None:
    """The cloth seen straight on, as one stands before its face or its back.

    Returns
    -------
    (height, width, 4) uint8, as wide and high as the cloth's
    :attr:`~knitcore_app.drawing.fabric.Ground.reach_mm`, opaque where there is cloth; None of a
    cloth that tubes show well: one of few stitches, or one that has left its plane.
    """
    if not looks_even(scene):
        return None
    reach = scene.ground.reach_mm
    stitch = STITCH / float(scene.ground.sizes_mm[..., 0].mean())
    scale = min(stitch, math.sqrt(PIXELS / reach.prod()), LONGEST / float(reach.max()))
    row = PARTS * float(scene.ground.sizes_mm[..., 1].mean())
    scale = max(math.floor(scale * row), 1) / row
    width, height = np.maximum(np.round(scale * reach).astype(int), 1).tolist()
    nothing = np.full((height, width), -np.inf, np.float32), np.empty((0, 3))
    balls = _balls(scene, scale, (width, height), -1 if back else 1)
    return _filled(drawn(balls, nothing))


def _balls(scene: FabricScene, scale: float, size: tuple[int, int], side: int) -> Balls:
    """Balls of all stitches, each with the tangents that its shape has at its mean size."""
    shapes, places = scene.shapes, scene.placement
    number = points_along(scene, scale)
    lines = resampled(shapes.lines, number)
    mean = np.column_stack([mean_sizes_mm(shapes, places), np.full(len(lines), places.depth)])
    along = np.gradient(lines * mean[:, None], axis=1) * [side, 1, side]
    along /= np.linalg.norm(along, axis=-1, keepdims=True)
    shown = slice(None) if scene.drawn is None else scene.drawn
    shape = shapes.index[shown].ravel()
    own: Floats = (scale * lines).astype(np.float32)[shape]
    own[..., :2] *= places.sizes_mm[shown].reshape(-1, 1, 2)
    angles = places.angles[shown].astype(np.float32).reshape(-1, 1)
    cosine, sine = np.cos(angles), np.sin(angles)
    away = scale * (places.centres_mm[shown].reshape(-1, 2) - scene.ground.middle_mm)
    # in step with pixels, and out of it again, the cloth would have bands
    away += np.random.default_rng(0).random((*shapes.index.shape, 2))[shown].reshape(-1, 2) - 0.5
    middle = (away + 0.5 * np.array(size) * [side, -1]).astype(np.float32)
    x = cosine * own[..., 0] - sine * own[..., 1] + middle[:, :1]
    y = sine * own[..., 0] + cosine * own[..., 1] + middle[:, 1:]
    return Balls(
        x=np.float32(side) * x,
        y=-y,
        z=np.float32(side * places.depth) * own[..., 2],
        along=along,
        shape=shape,
        radius=scale * shapes.yarn_radius_mm,
        colours=linear(scene.colours)[shown].reshape(-1, 3),
    )


def _filled(picture: Picture) -> Picture:
    """The picture with shade in the gaps between loops, and softened."""
    height, width = picture.shape[:2]
    image = Image.fromarray(picture, "RGBA").convert("RGBa")
    around = image.reduce(AROUND).resize((width, height), Image.Resampling.BILINEAR)
    mean = np.asarray(around).astype(np.float32)
    shade = GAP ** (1 / 2.2) * mean[..., :3] * (255 / np.maximum(mean[..., 3:], 1.0))
    cloth = scipy.ndimage.grey_closing(np.pad(picture[..., 3], CLOSED), (2 * CLOSED + 1,) * 2)
    filled = np.dstack([shade.astype(np.uint8), cloth[CLOSED:-CLOSED, CLOSED:-CLOSED]])
    filled = np.where(picture[..., 3:] > 0, picture, filled)
    soft = Image.fromarray(filled, "RGBA").convert("RGBa").filter(ImageFilter.GaussianBlur(SOFT))
    return np.asarray(soft.convert("RGBA"))
