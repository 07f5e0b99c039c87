"""Outlines with holes, parts that meet at a corner, and bridges."""

OUTLINES = {
    "hole": "xxxxxx\nxx..xx\nxx..xx\nxxxxxx",
    "slit": "xxxxxx\nx....x\nxxxxxx\nxxxxxx",
    "two holes": "xxxxxx\nx.xx.x\nx.xx.x\nxxxxxx",
    "holes that meet at a corner": "xxxxxx\nx.xxxx\nxx.xxx\nxxxxxx",
    "parts that meet at a corner": "...xxx\n...xxx\nxxx...\nxxx...",
    "bridge": "xx..xx\nxxxxxx\nxx..xx\nxx..xx",
}
