// Before the first paint, so that a chosen theme does not flash. A plain script: modules run later.
try {
  const theme = JSON.parse(localStorage.getItem("knitcore.settings") ?? "{}").theme;
  if (theme === "light" || theme === "dark") document.documentElement.dataset.theme = theme;
} catch {
  // Without a stored choice the system's theme applies.
}
