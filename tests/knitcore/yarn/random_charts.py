"""Charts of all kinds of stitches, and a yarn, for tests."""

from knitcore.yarn.model.yarn_model import YarnModel

ACRYLIC, LOOP_MM = YarnModel(0.046, 6e-4, 2.4, 0.74, 0.335), 11.3
"""The library's yarn of stockinette, and its loop length."""

EXAMPLES = {
    "stockinette": "KK;KK",
    "slip mosaic": "KKKK;VKVK;KKKK;KVKV",
    "slip, yarn in front": "KKKK;vKvK;KKKK;KvKv",
    "tuck every other": "KKKK;TKTK;KKKK;KTKT",
    "yo k2tog": "O/;KK",
    "ssk yo": "\\O;KK",
    "yo k2tog ssk yo": "O/\\O;KKKK",
    "cable 1/1": "[1/1R];KK",
    "cable 1/1, both ways": "[1/1R][1/1L];KKKK",
    "cable 2/2 between purls": "P[2/2R]P;PKKKKP;PKKKKP;PKKKKP",
    "cable 2/2": "[2/2L];KKKK;KKKK;KKKK",
    "rib 4x2": "KKKKPP",
    "twisted": "B",
    "twisted rib": "BP",
    "centred double": "KO^O;KKKK",
    "feather": "//OO;KKKK",
    "feather and fan": "//OOOO\\\\K;KKKKKKKKK",
    "cable 3/3": "[3/3R];KKKKKK",
    "held and twisted": "BKKK;TKKK;TKKK;KKKK",
}
"""Repeats of all kinds of stitches."""
