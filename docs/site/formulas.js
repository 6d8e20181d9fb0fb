// Sets the formulas of a page: pymdownx.arithmatex has put each of them into an element of its class, between \( \) or \[ \].
for (const formula of document.querySelectorAll(".arithmatex")) {
  const text = formula.textContent.trim()
  katex.render(text.slice(2, -2), formula, { displayMode: text.startsWith("\\["), throwOnError: false })
}
