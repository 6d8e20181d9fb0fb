// Sets the formulas of the built site by KaTeX, so that its pages need no script for them; fails at one that KaTeX can't
// read. pymdownx.arithmatex has put each into a span between \( and \), or into a div between \[ and \].
import { readdirSync, readFileSync, writeFileSync } from "node:fs"
import { createRequire } from "node:module"

const [site, packages] = process.argv.slice(2)
const katex = createRequire(`${process.cwd()}/${packages}/`)("katex")
const FORMULA = /(<(span|div) class="arithmatex">)\\[([](.*?)\\[)\]](?=<\/\2>)/gs
const decoded = html => html.replaceAll("&lt;", "<").replaceAll("&gt;", ">").replaceAll("&amp;", "&")

for (const name of readdirSync(site, { recursive: true }).filter(name => name.endsWith(".html"))) {
  const page = readFileSync(`${site}/${name}`, "utf8")
  try {
    const set = page.replace(FORMULA, (_, begin, tag, formula) =>
      begin + katex.renderToString(decoded(formula), { displayMode: tag === "div", strict: "error" }))
    writeFileSync(`${site}/${name}`, set)
  } catch (error) {
    console.error(`${name}: ${error.message}`)
    process.exitCode = 1
  }
}
