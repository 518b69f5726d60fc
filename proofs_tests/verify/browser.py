"""Debian's Chromium, driven by selenium: ``apt-get install chromium chromium-driver``."""

import json
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import cast

import pytest

__all__ = ["Page", "browser"]

#: Nothing that a browser does by itself, so that every request is the page's.
_ARGUMENTS = (
    *("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--hide-scrollbars"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage"),
)
#: Runs the body until the page has come to rest.
_ASYNC = """
const done = arguments[arguments.length - 1];
const rest = async () => {
  do await new Promise((resolve) => setTimeout(resolve, 30)); while (window.exactmesh.busy);
};
(async () => {
  await window.exactmesh.ready;
  const result = await (async (...given) => { %s })(...[...arguments].slice(0, -1));
  await rest();
  return result;
})().then((result) => done({ result: result ?? null }), (error) => done({ error: String(error.stack) }));
"""


class Page:
    """A page that is open."""

    def __init__(self, driver: object) -> None:
        from selenium.webdriver.chrome.webdriver import WebDriver

        assert isinstance(driver, WebDriver)
        self.driver = driver

    def open(self, text: str, folder: Path, *, dark: bool = False, size: tuple[int, int] = (1200, 800)) -> None:
        """Write the page to a file, and open it."""
        path = folder / "page.html"
        path.write_text(text, encoding="utf-8")
        width, height = size
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        still = {"name": "prefers-reduced-motion", "value": "reduce"}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme, still]})
        self._log("browser")  # those of the page before
        self._log("performance")
        self.driver.get(path.as_uri())

    def run(self, script: str, *arguments: object) -> object:
        """Run the body of an asynchronous function when the page is ready; return its result when the page rests."""
        answer = self.driver.execute_async_script(_ASYNC % script, *arguments)
        assert "error" not in answer, answer["error"]
        return cast("object", answer["result"])

    def _log(self, name: str) -> list[str]:
        entries = self.driver.get_log(name)  # type: ignore[no-untyped-call]  # selenium left it out
        return [str(entry["message"]) for entry in entries]

    def complaints(self) -> list[str]:
        """Return what the console holds."""
        return self._log("browser")

    def requests(self) -> list[str]:
        """Return the addresses that were asked for, but for pages on file and data in the page."""
        messages = [json.loads(entry)["message"] for entry in self._log("performance")]
        urls = [m["params"]["request"]["url"] for m in messages if m["method"] == "Network.requestWillBeSent"]
        return [url for url in urls if not url.startswith(("file:", "data:"))]


@contextmanager
def browser() -> Iterator[Page]:
    """Start a browser, or skip the test with the reason why there is none: fail if EXACTMESH_REQUIRE_BROWSER=1."""
    chromium, chromedriver = shutil.which("chromium"), shutil.which("chromedriver")
    if chromium is None or chromedriver is None:
        missing = pytest.fail if os.environ.get("EXACTMESH_REQUIRE_BROWSER") == "1" else pytest.skip
        missing("no browser: apt-get install chromium chromium-driver")
    pytest.importorskip("selenium")
    from selenium.webdriver import Chrome
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service

    options = Options()
    options.binary_location = chromium
    for argument in _ARGUMENTS:
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = Chrome(options=options, service=Service(chromedriver))
    driver.set_script_timeout(120)
    try:
        yield Page(driver)
    finally:
        driver.quit()
