"""From measurements of a body to a chart: gauge, outline, regions, templates, yarn."""
