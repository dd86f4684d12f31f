"""A chromium without a window, driven over a pair of pipes: no package, no port, no network."""

import base64
import json
import os
import subprocess
from pathlib import Path


class Browser:
    """A chromium without a window. It speaks the DevTools protocol: JSON, each message ended by a zero."""

    def __init__(self, home):
        to_read, self.to = os.pipe()
        self.of, of_write = os.pipe()
        # The protocol takes the descriptors 3 and 4; copies high above leave both free.
        high = [os.dup2(to_read, 103), os.dup2(of_write, 104)]
        line = 'exec 3<&103 4>&104 103<&- 104>&-; exec chromium "$@"'
        options = ["--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe", "--mute-audio",
                   "--no-first-run", "--disable-background-networking", "--force-color-profile=srgb",
                   "--disable-dev-shm-usage", f"--user-data-dir={home}/profile", "about:blank"]
        self.process = subprocess.Popen(["bash", "-c", line, "bash", *options], pass_fds=high,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for end in [to_read, of_write, *high]:
            os.close(end)
        self.number, self.rest, self.events, self.session = 0, b"", [], None
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Network", "Log", "Accessibility"]:
            self.ask(f"{domain}.enable")

    def ask(self, method, **params):
        self.number += 1
        message = {"id": self.number, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self.events.append(answer)

    def receive(self):
        while b"\0" not in self.rest:
            more = os.read(self.of, 1 << 20)
            if not more:
                raise RuntimeError("the browser has stopped")
            self.rest += more
        message, self.rest = self.rest.split(b"\0", 1)
        return json.loads(message)

    def run(self, script):
        """The value of an expression in the page; promises are waited for."""
        answer = self.ask("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{script}: {answer['exceptionDetails']['exception'].get('description')}")
        return answer["result"].get("value")

    def open(self, path, script_is_on=True):
        self.ask("Emulation.setScriptExecutionDisabled", value=not script_is_on)
        self.events.clear()
        self.ask("Page.navigate", url=Path(path).resolve().as_uri())
        while not any(event.get("method") == "Page.loadEventFired" for event in self.events):
            self.events.append(self.receive())
        if script_is_on:
            self.run("""new Promise((done, fail) => {
                const [start, root] = [Date.now(), document.documentElement];
                const look = () => root.dataset.ready ? done() : Date.now() - start > 60000
                    ? fail(new Error("the page is not ready: " + document.getElementById("notice").textContent))
                    : setTimeout(look, 20);
                look();
            })""")

    def show(self, width, height, scheme="light", motion="no-preference", scale=1):
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale,
                 mobile=width < 600)
        features = [{"name": "prefers-color-scheme", "value": scheme},
                    {"name": "prefers-reduced-motion", "value": motion}]
        self.ask("Emulation.setEmulatedMedia", media="", features=features)
        self.settle()

    def settle(self):
        """Waits until what is due is drawn."""
        self.run("new Promise((done) => setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(done)), 60))")

    def key(self, key, text="", shift=False):
        codes = {"ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40, "Home": 36, "End": 35,
                 "Escape": 27, " ": 32}
        params = {"key": key, "windowsVirtualKeyCode": codes.get(key, ord(key[0].upper())),
                  "modifiers": 8 if shift else 0}
        if text or len(key) == 1:
            params["text"] = text or key
        self.ask("Input.dispatchKeyEvent", type="keyDown", **params)
        self.ask("Input.dispatchKeyEvent", type="keyUp", **params)
        self.settle()

    def mouse(self, kind, x, y, **params):
        self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, **params)

    def click(self, x, y):
        for kind in ["mousePressed", "mouseReleased"]:
            self.mouse(kind, x, y, button="left", clickCount=1)
        self.settle()

    def screenshot(self, file):
        Path(file).write_bytes(base64.b64decode(self.ask("Page.captureScreenshot")["data"]))

    def complaints(self):
        """Errors and warnings of the page, and every address that it asked for besides its own."""
        found = []
        for event in self.events:
            method, params = event.get("method"), event.get("params", {})
            if method == "Runtime.exceptionThrown":
                found.append(params["exceptionDetails"].get("exception", {}).get("description"))
            elif method == "Runtime.consoleAPICalled":
                found.append(f"console: {params['args']}")
            elif method == "Log.entryAdded" and "willReadFrequently" not in params["entry"]["text"]:
                # That one is about this test, which reads what the page has drawn.
                found.append(f"log: {params['entry']['text']}")
            elif method == "Network.requestWillBeSent":
                url = params["request"]["url"]
                if not url.startswith(("file:", "data:")) or params.get("type") not in ("Document", "Image", None):
                    found.append(f"asked for {url[:100]}")
        return found

    def close(self):
        self.ask("Browser.close")
        self.process.wait(timeout=20)
