# SPDX-License-Identifier: BSD-3-Clause
"""Opens reports in Chromium: report_browser.py PROGRAM SOURCE_FOLDER [SCREENSHOT_FOLDER]

Ends with status 77, and a reason, where Chromium, its driver or Selenium is missing.
"""

import base64
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import report_pages  # noqa: E402


def skip(reason):
    print(f"tests/browser/report_browser.py: Skipped\n{reason}\n[  SKIPPED ] Browser.Report (0 ms)")
    sys.exit(77)


try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    skip("Selenium is missing: apt-get install python3-selenium")

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SHOTS = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None


def open_browser(*more):
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    # In a container as root there is no sandbox; without a GPU, SwiftShader draws.
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                     "--hide-scrollbars", *more):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    service = webdriver.chrome.service.Service(shutil.which("chromedriver"))
    return webdriver.Chrome(service=service, options=options)


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.temporary.name)
        cls.pages = {"calibration": report_pages.calibrated(PROGRAM, SOURCE, folder),
                     "untrusted": report_pages.untrusted(PROGRAM, folder / "untrusted"),
                     "batch": report_pages.batch(PROGRAM, folder / "batch")}
        cls.columns, cls.data = report_pages.cloud_of(cls.pages["calibration"])
        cls.browser = open_browser("--window-size=1600,1200")

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        cls.temporary.cleanup()

    def open(self, name, fragment="", width=1600, height=1200):
        self.browser.get("about:blank")
        self.browser.get_log("browser"), self.browser.get_log("performance")
        self.browser.set_window_size(width, height)
        self.browser.get(self.pages[name].as_uri() + fragment)

    def js(self, script, *arguments):
        return self.browser.execute_script("return " + script, *arguments)

    def wait_for(self, condition, what):
        end = time.monotonic() + 30
        while not condition():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.1)

    def open_cloud(self, fragment="", **size):
        self.open("calibration", fragment, **size)
        self.wait_for(lambda: self.js("!!window.crispViewer && crispViewer.frames > 0"), "the cloud was not drawn")
        self.js("crispViewer.stage.scrollIntoView({block: 'center'})")

    def drawn(self):
        """Draws, and returns the share of the canvas that points cover, and a checksum."""
        return self.js("""(() => { crispViewer.draw(); const gl = crispViewer.renderer.gl, w = gl.drawingBufferWidth, h = gl.drawingBufferHeight;
            const pixels = new Uint8Array(4 * w * h); gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
            let lit = 0, sum = 0;
            for (let i = 0; i < pixels.length; i += 4) { if (pixels[i] + pixels[i + 1] + pixels[i + 2] > 120) { ++lit; sum = (sum + i * (pixels[i] + 1)) % 1000003; } }
            return [lit / (w * h), sum]; })()""")

    def at(self, i, when=""):
        return [self.columns[axis + when][i] for axis in "xyz"]

    def isolate(self, points):
        """Clips all but some points, and views their middle from above."""
        low = [min(p[a] for p in points) - 0.002 for a in range(3)]
        high = [max(p[a] for p in points) + 0.002 for a in range(3)]
        middle = [(l + h) / 2 for l, h in zip(low, high)]
        self.js("""crispViewer.change(() => { Object.assign(crispViewer, {low: arguments[0], high: arguments[1]});
            Object.assign(crispViewer.camera, {target: arguments[2], distance: arguments[3], yaw: 0.3, pitch: 1.2}); })""", low, high, middle,
                max(1.0, 2 * math.dist(low, high)))
        self.drawn()

    def click(self, point):
        x, y = self.js("crispViewer.project(arguments[0])", point)
        stage = self.browser.find_element(By.CSS_SELECTOR, ".stage")
        width, height = stage.size["width"], stage.size["height"]
        ActionChains(self.browser).move_to_element_with_offset(stage, round(x - width / 2), round(y - height / 2)).click().perform()
        return self.facts()

    def facts(self):
        names = [e.text for e in self.browser.find_elements(By.CSS_SELECTOR, ".stage .facts dt")]
        values = [e.text for e in self.browser.find_elements(By.CSS_SELECTOR, ".stage .facts dd")]
        return dict(zip(names, values))

    def shoot(self, name):
        if SHOTS:
            self.browser.save_screenshot(str(SHOTS / f"{name}.png"))

    def test_pages_print_nothing_to_the_console(self):
        for name in self.pages:
            self.open(name)
            time.sleep(1)
            self.assertEqual([m for m in self.browser.get_log("browser")], [], name)

    def test_pages_request_nothing(self):
        for name, page in self.pages.items():
            self.open(name)
            time.sleep(1)
            messages = [entry["message"] for entry in self.browser.get_log("performance")]
            urls = [m["params"]["request"]["url"] for m in (json.loads(t)["message"] for t in messages) if m["method"] == "Network.requestWillBeSent"]
            foreign = [u for u in urls if not u.startswith(("data:", "blob:", "about:")) and u.split("#")[0] != page.as_uri()]
            self.assertEqual(foreign, [], name)

    def test_the_verdict_comes_first(self):
        self.open("calibration")
        self.assertEqual(self.browser.find_element(By.CSS_SELECTOR, "section .badge").text, "trusted")
        self.open("untrusted")
        verdict = self.browser.find_element(By.CSS_SELECTOR, "section")
        self.assertIn("untrusted", verdict.text)
        self.assertIn("front and back views agree on 45 %", verdict.text)
        self.shoot("untrusted")

    def test_all_sections_are_there(self):
        self.open("calibration")
        sections = [e.get_attribute("id") for e in self.browser.find_elements(By.CSS_SELECTOR, "section")]
        self.assertEqual(sections, ["verdict", "parameters", "cloud", "devices", "origin"])
        self.assertEqual(len(self.browser.find_elements(By.CSS_SELECTOR, "#parameters tbody tr")), 12 + len(self.browser.find_elements(By.CSS_SELECTOR, "#parameters details tbody tr")))
        self.open("untrusted")
        self.assertEqual(len(self.browser.find_elements(By.CSS_SELECTOR, ".finding")), 2)
        panels = self.browser.find_elements(By.CSS_SELECTOR, ".finding img")
        self.assertEqual([p.get_attribute("alt") for p in panels], ["laser1 against mirror angle: 1 mm"])
        self.js("arguments[0].scrollIntoView()", panels[0])
        self.wait_for(lambda: self.js("arguments[0].naturalWidth", panels[0]) == 640, "the panel was not drawn")

    def test_names_in_data_are_text(self):
        for name in ("untrusted", "batch"):
            self.open(name)
            time.sleep(0.5)
            self.assertIsNone(self.js("window.attacked"), name)
            self.assertEqual(self.js("document.querySelectorAll('[onerror], [onload]').length"), 0)
            self.assertIn("onerror=", self.browser.find_element(By.TAG_NAME, "body").text)

    def test_points_are_drawn(self):
        self.open_cloud()
        self.assertGreater(self.drawn()[0], 0.05)
        self.shoot("cloud")

    def test_the_key_b_switches_between_before_and_after(self):
        self.open_cloud()
        after = self.drawn()
        stage = self.browser.find_element(By.CSS_SELECTOR, ".stage")
        stage.send_keys("b")
        before = self.drawn()
        self.assertIn("before", stage.text)
        self.assertNotEqual(before[1], after[1])
        self.shoot("before")
        stage.send_keys("b")
        self.assertEqual(self.drawn(), after)

    def test_the_slider_moves_points_from_before_to_after(self):
        self.open_cloud()
        slider = self.browser.find_element(By.ID, "mix")
        slider.send_keys(Keys.HOME)
        self.assertEqual(self.js("crispViewer.mix"), 0)
        i = 1000
        for found, truth in zip(self.js("crispViewer.cloud.at(arguments[0], crispViewer.mix)", i), self.at(i, "_before")):
            self.assertAlmostEqual(found, truth, places=4)
        slider.send_keys(Keys.END)
        for found, truth in zip(self.js("crispViewer.cloud.at(arguments[0], crispViewer.mix)", i), self.at(i)):
            self.assertAlmostEqual(found, truth, places=4)

    def test_a_click_picks_the_point_that_is_there(self):
        self.open_cloud()
        n = len(self.columns["x"])
        for i in range(n // 7, n, n // 7):
            self.isolate([self.at(i)])
            facts = self.click(self.at(i))
            same = [k for k in range(n) if max(abs(a - b) for a, b in zip(self.at(k), self.at(i))) < 0.0021]
            beams = {(f"laser{int(self.columns['laser'][k]) + 1}", str(int(self.columns["beam"][k]))) for k in same}
            self.assertIn((facts["laser"], facts["beam"]), beams)
            if len(same) == 1:
                self.assertEqual(facts["range"], f"{self.columns['range'][i]:.3f} m")
                self.assertAlmostEqual(float(facts["time"].split()[0]), self.columns["time"][i], places=2)

    def test_two_clicks_measure_a_distance(self):
        self.open_cloud()
        i, n = 5000, len(self.columns["x"])
        j = next(k for k in range(n) if 1 < math.dist(self.at(i), self.at(k)) < 2 and abs(self.at(i)[2] - self.at(k)[2]) < 0.3)
        self.browser.find_element(By.ID, "measure").click()
        for k in (i, j):
            self.isolate([self.at(k)])
            facts = self.click(self.at(k))
        self.assertAlmostEqual(float(facts["measured"].split()[0]), math.dist(self.at(i), self.at(j)), delta=0.006)

    def touch(self, kind, points):
        self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(points)]})

    def test_one_finger_turns_and_two_fingers_zoom(self):
        self.open_cloud()
        self.browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})
        try:
            x, y = self.js("(() => { const r = crispViewer.stage.getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()")
            view = lambda: self.js("[crispViewer.camera.yaw, crispViewer.camera.distance]")
            yaw, distance = view()
            self.touch("touchStart", [(x, y)])
            for step in range(1, 6):
                self.touch("touchMove", [(x + 20 * step, y)])
            self.touch("touchEnd", [])
            turned = view()
            self.assertGreater(abs(turned[0] - yaw), 0.2)
            self.assertAlmostEqual(turned[1], distance)
            self.touch("touchStart", [(x - 40, y), (x + 40, y)])
            for step in range(1, 6):
                self.touch("touchMove", [(x - 40 - 8 * step, y), (x + 40 + 8 * step, y)])
            self.touch("touchEnd", [])
            self.assertAlmostEqual(view()[1], distance / 2, delta=0.1 * distance)
        finally:
            self.browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": False})

    def open_panels(self):
        self.open("untrusted")
        fold = next(e for e in self.browser.find_elements(By.CSS_SELECTOR, "#findings details") if "without a significant" in e.text)
        self.js("arguments[0].open = true", fold)
        panels = fold.find_elements(By.CSS_SELECTOR, "figure.panel")
        self.assertEqual(len(panels), 2)
        self.js("arguments[0].scrollIntoView({block: 'center'})", panels[0])
        return fold, panels

    def marks(self, panel):
        """Numbers along the axes of a plot, those along y and those along x."""
        texts = self.js("[...arguments[0].querySelectorAll('svg.plot text')].map((t) => [t.getAttribute('text-anchor'), t.textContent])", panel)
        number = lambda t: float(t.replace("\u2212", "-"))
        along = lambda anchor: [number(t) for a, t in texts if a == anchor and t.replace(".", "").replace("-", "").isdigit()]
        return along("end"), along("middle")

    def test_plots_of_a_quantity_have_one_scale_unless_switched_off(self):
        fold, (small, large) = self.open_panels()
        self.assertEqual(self.marks(small)[0], self.marks(large)[0])
        self.assertEqual(max(self.marks(small)[0]), 10)
        fold.find_element(By.CSS_SELECTOR, "input.common-scale").click()
        self.assertLess(max(self.marks(small)[0]), 2)
        self.assertEqual(max(self.marks(large)[0]), 10)

    def test_a_plot_zooms_by_a_drag_and_by_keys(self):
        _, (_, panel) = self.open_panels()
        plot = panel.find_element(By.CSS_SELECTOR, "svg.plot")
        whole = self.marks(panel)
        width, height = plot.size["width"], plot.size["height"]
        ActionChains(self.browser).move_to_element_with_offset(plot, round(0.1 * width), round(-0.2 * height)).click_and_hold() \
            .move_by_offset(round(0.2 * width), round(0.3 * height)).release().perform()
        zoomed = self.marks(panel)
        self.assertLess(max(zoomed[1]) - min(zoomed[1]), max(whole[1]) - min(whole[1]))
        self.assertGreater(min(zoomed[1]), 2)
        self.shoot("zoomed")
        panel.send_keys("0")
        self.assertEqual(self.marks(panel), whole)
        panel.send_keys("+")
        self.assertEqual(min(self.marks(panel)[1]), 1)
        ActionChains(self.browser).double_click(panel.find_element(By.CSS_SELECTOR, "svg.plot")).perform()
        self.assertEqual(self.marks(panel), whole)

    def test_the_address_keeps_the_view(self):
        self.open_cloud("#view&yaw=0.5&pitch=0.25&distance=7&target=1,2,3&mix=0&colour=height&size=3")
        self.assertEqual(self.js("[crispViewer.camera.yaw, crispViewer.camera.pitch, crispViewer.camera.distance, ...crispViewer.camera.target, crispViewer.mix, crispViewer.size]"),
                         [0.5, 0.25, 7, 1, 2, 3, 0, 3])
        self.browser.find_element(By.CSS_SELECTOR, ".stage").send_keys("2", Keys.ARROW_LEFT)
        self.wait_for(lambda: "yaw=0.42" in self.browser.current_url, self.browser.current_url)

    def test_every_colour_differs(self):
        self.open_cloud()
        sums = {}
        for option in self.js("[...document.querySelectorAll('#colour option')].map((o) => o.value)"):
            self.js("crispViewer.setColour(arguments[0])", option)
            sums[option] = self.drawn()[1]
            self.shoot(f"colour_{option}")
        self.assertEqual(set(sums), {"laser", "height", "remission", "time", "distance", "incidence", "range"})
        self.assertEqual(len(set(sums.values())), len(sums), sums)

    def test_without_webgl_there_is_a_picture_and_a_sentence(self):
        browser = open_browser("--disable-3d-apis", "--window-size=1000,800")
        try:
            browser.get(self.pages["calibration"].as_uri())
            end = time.monotonic() + 30
            while not browser.find_elements(By.CSS_SELECTOR, "canvas.picture") and time.monotonic() < end:
                time.sleep(0.1)
            self.assertIn("WebGL", browser.find_element(By.ID, "cloud").text)
            lit = browser.execute_script("const c = document.querySelector('canvas.picture'); const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
                                         "let n = 0; for (let i = 0; i < d.length; i += 4) n += d[i + 1] > 40; return n / (c.width * c.height);")
            self.assertGreater(lit, 0.02)
        finally:
            browser.quit()

    def test_pages_fit_a_phone_and_a_wide_screen(self):
        for name in self.pages:
            for width in (400, 1600):
                self.open(name)
                self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500})
                time.sleep(1)
                self.assertLessEqual(self.js("document.documentElement.scrollWidth"), width, name)
                self.shoot(f"{name}_{width}")
                self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    def test_pages_print(self):
        for name in self.pages:
            self.open(name)
            time.sleep(2)
            pdf = base64.b64decode(self.browser.execute_cdp_cmd("Page.printToPDF", {"printBackground": True, "preferCSSPageSize": True})["data"])
            self.assertTrue(pdf.startswith(b"%PDF"))
            self.assertGreater(len(pdf), 10000)
            if SHOTS:
                (SHOTS / f"{name}.pdf").write_bytes(pdf)

    def test_the_page_is_dark_where_the_system_is(self):
        self.open("calibration")
        for scheme, is_dark in (("dark", True), ("light", False)):
            self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
            red = int(self.js("getComputedStyle(document.body).backgroundColor.match(/\\d+/)[0]"))
            self.assertEqual(red < 128, is_dark)
            self.shoot(f"scheme_{scheme}")

    def test_a_batch_sorts_and_filters(self):
        self.open("batch")
        names = lambda: [e.text for e in self.browser.find_elements(By.CSS_SELECTOR, "table.batch tbody td:first-child")]
        head = next(e for e in self.browser.find_elements(By.CSS_SELECTOR, "table.batch th button") if e.text == "points")
        head.click(), head.click()
        self.assertEqual(names()[:3], ["day 11", "day 10", "day 9"])
        self.browser.find_element(By.CSS_SELECTOR, "input[type=search]").send_keys("failed")
        self.assertEqual(names(), ["day 3"])
        self.shoot("batch_filtered")

    def test_a_batch_marks_what_stands_out(self):
        self.open("batch")
        outliers = self.browser.find_elements(By.CSS_SELECTOR, "#trends .outlier title")
        self.assertEqual([self.js("arguments[0].textContent", e)[:5] for e in outliers], ["day 7"])
        self.assertEqual(len(self.browser.find_elements(By.CSS_SELECTOR, "#trends .point")), 10)

    def test_a_batch_leads_to_the_reports_of_its_runs(self):
        self.open("batch")
        for name in ("day 0", "javascript:"):
            link = next(e for e in self.browser.find_elements(By.CSS_SELECTOR, "table.batch a") if e.text.startswith(name))
            self.assertTrue(link.get_attribute("href").startswith("file:///"))
            link.click()
            self.assertEqual(self.browser.title, "the report of a run")
            self.open("batch")

    def test_scripts_are_of_the_types_they_say(self):
        if not shutil.which("tsc"):
            self.skipTest("TypeScript is missing: apt-get install node-typescript")
        done = subprocess.run(["tsc", "-p", SOURCE / "plugins/report/page"], capture_output=True, text=True)
        self.assertEqual(done.stdout, "")


def main():
    for name, package in (("chromium", "chromium"), ("chromedriver", "chromium-driver")):
        if not shutil.which(name):
            skip(f"{name} is missing: apt-get install {package}")
    suite = unittest.defaultTestLoader.loadTestsFromTestCase(Report)
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(suite)
    for test, reason in result.skipped:
        print(f"tests/browser: Skipped\n{reason}\n[  SKIPPED ] Browser.{test.id().split('.')[-1]} (0 ms)")
    print(f"[==========] {result.testsRun} tests from 1 test suite ran.")
    sys.exit(0 if result.wasSuccessful() else 1)


if __name__ == "__main__":
    main()
