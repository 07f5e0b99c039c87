"""The 3D view of a design: one private viser server each, relayed through the page's own port."""
