"""A headless browser that opens a page and answers questions about it."""

from __future__ import annotations

import html
import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
SECONDS = 120
#: --no-sandbox: containers often forbid the sandbox, and the page is our own; no name resolves, so nothing can be fetched
OPTIONS = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars", "--no-first-run",
           "--host-resolver-rules=MAP * ~NOTFOUND")
#: colour schemes that the reader may prefer
SCHEMES = {"dark": "--blink-settings=preferredColorScheme=0", "light": "--blink-settings=preferredColorScheme=1"}
#: collects errors, before anything else on the page runs
WATCH = """<script>
const faults = [];
addEventListener("error", (event) => faults.push(String(event.message || event.target.outerHTML).slice(0, 200)), true);
addEventListener("securitypolicyviolation", (event) => faults.push("fetched " + event.blockedURI));
for (const name of ["error", "warn"]) console[name] = (...words) => faults.push(words.join(" "));
</script>"""
#: the page in a frame of a width, because windows have a least width, and the answer of its function once all is loaded
FRAME = """<!DOCTYPE html><title>asks</title>
<iframe style="width: {width}px; height: 900px; border: 0" srcdoc="{page}"></iframe>
<script>addEventListener("load", async () => {{
  const answer = document.createElement("pre");
  try {{ answer.textContent = JSON.stringify(await frames[0].question()); }}
  catch (error) {{ answer.textContent = JSON.stringify({{error: String(error)}}); }}
  answer.id = "the-answer";
  document.body.append(answer);
}});</script>"""


class Browser:
    """Runs the browser anew for every question, with a profile of its own."""

    def __init__(self, program: str, folder: Path):
        self.program, self.folder = program, folder

    def _run(self, *arguments: str) -> subprocess.CompletedProcess:
        profile = f"--user-data-dir={self.folder / 'profile'}"
        return subprocess.run([self.program, *OPTIONS, profile, *arguments], capture_output=True, text=True, timeout=SECONDS,
                              check=False)

    def works(self) -> str:
        """The reason why it does not start; empty if it does."""
        try:
            done = self._run("--dump-dom", "data:text/html,<p>here</p>")
        except (OSError, subprocess.TimeoutExpired) as error:
            return str(error)
        return "" if "<p>here</p>" in done.stdout else f"exit status {done.returncode}: {done.stderr.strip()[-300:]}"

    def ask(self, page: Path, script: str, width: int, scheme: str = "light"):
        """The answer of an async function run in the page, in a window of this width, in the light or dark scheme."""
        text = page.read_text(encoding="utf-8").replace("<head>", f"<head>{WATCH}", 1)
        asked = self.folder / "asked.html"
        before, end, after = text.rpartition("</body>")  # the page's own; a library may speak of others
        text = f"{before}<script>async function question() {{ {script} }}</script>{end}{after}"
        asked.write_text(FRAME.format(width=width, page=html.escape(text)), encoding="utf-8")
        window = ("--window-size=1500,1000", "--virtual-time-budget=10000", SCHEMES[scheme])
        done = self._run(*window, "--dump-dom", asked.as_uri())
        answer = re.search(r'<pre id="the-answer">(.*?)</pre>', done.stdout, re.S)
        assert answer, f"the page gave no answer: {done.stderr[-500:]}"
        return json.loads(html.unescape(answer[1]))

    def pdf(self, page: Path) -> Path:
        """The page as it prints."""
        out = self.folder / "page.pdf"
        done = self._run("--no-pdf-header-footer", f"--print-to-pdf={out}", page.as_uri())
        assert out.is_file(), done.stderr[-500:]
        return out


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """A browser that starts on this machine; without one, tests that need it are skipped and say why."""
    program = next(filter(None, map(shutil.which, NAMES)), None)
    if program is None:
        pytest.skip(f"no browser is installed (looked for {', '.join(NAMES)})")
    started = Browser(program, tmp_path_factory.mktemp("browser"))
    problem = started.works()
    if problem:
        pytest.skip(f"{program} does not start here: {problem}")
    return started
