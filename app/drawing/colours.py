"""Colours of stitches in the 3D view: the same meaning and the same maps as on the page."""

import re

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import ImageColor

from knitcore.chart.fabric import PHASES, Fabric

Colours = NDArray[np.uint8]

FABRIC_COLOURS: dict[Fabric, str] = {
    Fabric.STOCKINETTE: "3f74b5",
    Fabric.GARTER: "d98032",
    Fabric.RIB: "4a9a5b",
    Fabric.SEED: "8a62ad",
}

SKIN = (226, 205, 188)
UNDYED = "d8c6ab"
"""Colour of undyed wool, for yarns whose names hold no colour."""
MAKERS_COLOURS = {
    "white": "f1ede4",
    "black": "2b2a2c",
    "natural": UNDYED,
    "ecru": "d9cdb4",
    "rice": "ece4d3",
    "celeste": "9fc6d8",
    "brume": "b4bac0",
    "sapphire": "1f4aa8",
}
"""Yarn makers' colours by name. Web colours lack these names, or use them for pure light."""

BATLOW = (
    "011959 08255b 0d315d 0f3b5f 114360 134b61 175262 1b5962 226061 2b655e 356a59 "
    "416f53 4d734d 5a7745 677b3e 747e38 828231 8f862d 9f892b af8d2e be9035 cd923f "
    "db954b e7985a f19d6b f8a27e fca890 fdaea2 fdb4b4 fdbac4 fcbfd6 fbc6e8 faccfa"
)
"""Fabio Crameri's map for growing quantities (MIT licence, doi:10.5281/zenodo.1243862)."""

VIK = (
    "001261 021f69 022b71 023779 034481 055189 0c5e92 1c6d9c 307da6 488db2 619ebd "
    "7aaec8 94bed2 adcddd c6dbe6 dee6e9 ece5e0 eedbd0 e9ccba e3bca5 dcac90 d69d7c "
    "cf8e68 c98056 c37243 bd6431 b3531f a5400f 942f06 832106 741506 670a07 590008"
)
"""His map for signed quantities."""


def named_colour(name: str) -> tuple[int, int, int]:
    """The colour in the name of a yarn; that of undyed wool if there is none.

    Examples
    --------
    >>> named_colour("082L Pearl cotton 3/2, 1800-13 sapphire"), named_colour("Merino, navy")
    ((31, 74, 168), (0, 0, 128))
    """
    words = re.findall(r"[a-z]+", name.lower())[::-1]  # makers say the kind first, then the colour
    for known in (MAKERS_COLOURS, ImageColor.colormap):
        for word in words:
            if word in known:
                return rgb(MAKERS_COLOURS.get(word) or str(ImageColor.colormap[word]))
    return rgb(UNDYED)


def linear(colours: Colours) -> Colours:
    """Display colours as the renderer takes those of instances: proportional to light."""
    return np.round(255 * (colours / 255.0) ** 1.8).astype(np.uint8)


def _stops(text: str) -> NDArray[np.float64]:
    return np.array([list(bytes.fromhex(stop)) for stop in text.split()], dtype=float)


def sequential(values: ArrayLike, low: float, high: float, *, log: bool = False) -> Colours:
    """batlow between two values, shape (..., 3); ``log`` spaces them by ratios."""
    x = np.asarray(values, dtype=float)
    if log:
        x, low, high = np.log(x), np.log(low), np.log(high)
    return _mapped((x - low) / max(high - low, 1e-12), _stops(BATLOW))


def diverging(values: ArrayLike, most: float) -> Colours:
    """vik between -most and +most, shape (..., 3)."""
    x = np.asarray(values, dtype=float)
    return _mapped(0.5 + 0.5 * x / max(most, 1e-12), _stops(VIK))


def fabric_mix(fractions: NDArray[np.float64], palette: Colours | None = None) -> Colours:
    """Fabric colours mixed by shares, (..., 4) in the order of the phase codes -> (..., 3)."""
    if palette is None:
        palette = np.array([rgb(FABRIC_COLOURS[fabric]) for fabric in PHASES], dtype=np.uint8)
    # Light adds in linear space: mixing there keeps half-and-half stitches as bright as pure ones.
    mixed: NDArray[np.float64] = (fractions @ (palette / 255.0) ** 2.2) ** (1 / 2.2)
    return np.round(255 * mixed).astype(np.uint8)


def rgb(colour: str) -> tuple[int, int, int]:
    """Red, green and blue of a hexadecimal colour, with or without #."""
    red, green, blue = bytes.fromhex(colour.removeprefix("#"))
    return red, green, blue


def _mapped(t: NDArray[np.float64], stops: NDArray[np.float64]) -> Colours:
    position = np.clip(np.nan_to_num(t), 0.0, 1.0) * (len(stops) - 1)
    channels = [np.interp(position, np.arange(len(stops)), stops[:, c]) for c in range(3)]
    return np.round(np.stack(channels, axis=-1)).astype(np.uint8)
