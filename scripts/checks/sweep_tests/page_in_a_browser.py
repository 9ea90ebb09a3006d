"""Opens a sweep's page in headless Chromium: page_in_a_browser.py PAGE [SCREENSHOT]. Exit code 1: a check failed."""
import json
import os
import re
import shutil
import sys
import time
from pathlib import Path

from selenium import webdriver
from selenium.webdriver import ActionChains, Keys
from selenium.webdriver.common.by import By
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import WebDriverWait

LONGEST_OPENING = 2.0  # seconds, for a page of 500 runs
failures = []


def check(condition, words):
    print(f"{'passed' if condition else 'FAILED'}  {words}", flush=True)
    if not condition:
        failures.append(words)


def open_browser():
    options = webdriver.ChromeOptions()
    # The parallel coordinates need WebGL, rendered in software.
    for argument in ("--headless=new", "--no-sandbox", "--window-size=1500,1300", "--enable-unsafe-swiftshader",
                     "--disable-dev-shm-usage"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"performance": "ALL", "browser": "ALL"})
    return webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)


def open_page(driver, address):
    """Seconds, measured by the browser, until plot and list are usable, and until the parallel coordinates are."""
    driver.get(address)
    WebDriverWait(driver, 60, 0.05).until(lambda d: d.execute_script("return document.body.dataset.complete"))
    return tuple(driver.execute_script(f"return Number(document.body.dataset.{mark}) / 1000") for mark in ("ready", "complete"))


def requests(driver):
    """Requested addresses other than the page itself."""
    sent = [json.loads(entry["message"])["message"] for entry in driver.get_log("performance")]
    urls = [each["params"]["request"]["url"] for each in sent if each["method"] == "Network.requestWillBeSent"]
    return [url for url in urls if url.startswith(("http", "ws", "ftp"))]


def points(driver, front):
    """Marks of the scatter plot: those of the front, or the others."""
    traces = driver.find_elements(By.CSS_SELECTOR, "#scatter .scatterlayer .trace")
    return traces[1 if front else 0].find_elements(By.CSS_SELECTOR, "path.point")


def colours(driver):
    """Numbers of lines of the parallel coordinates that are grey (0), selected (1), selected and on the front (2)."""
    of = driver.execute_script("return Array.from(document.getElementById('parallel').data[0].line.color)")
    return [of.count(k) for k in range(3)]


def settle():
    time.sleep(0.7)


def try_clicks(driver, data):
    columns = [column["name"] for column in data["columns"]]
    mark = points(driver, front=True)[0]
    ActionChains(driver).move_to_element(mark).click().perform()
    settle()
    details = driver.find_element(By.ID, "details").text
    run = int(re.search(r"Run (\d+)", details)[1])
    row = next(each for each in data["rows"] if each["run"] == run)
    check(row["cells"][columns.index("front")] == 1, f"a click on the front shows a design of the front, run {run}")
    check(row["command"] in details and row["command"].startswith("scripts/run "), "its command line")
    check(all(key in details for key in row["settings"]), "its keys")
    check(row["bottleneck"] in details, "its bottleneck")
    timing = driver.find_element(By.CSS_SELECTOR, "#details pre.timing").get_attribute("textContent")
    check(timing == row["timing"] and "bottleneck:" in timing, "its timing table")
    ActionChains(driver).key_down(Keys.SHIFT).click(points(driver, front=True)[-1]).key_up(Keys.SHIFT).perform()
    settle()
    check(len(driver.find_elements(By.CSS_SELECTOR, "#comparison tr:first-child th")) == 3, "Shift and a click compares two designs")
    both = driver.execute_script("return chosen")
    rows = [next(each for each in data["rows"] if each["run"] == run) for run in both]
    marked = {element.find_element(By.TAG_NAME, "td").text for element in
              driver.find_elements(By.CSS_SELECTOR, "#comparison tr.differs")}
    keys = {key for each in rows for key in each["settings"]}
    different = {key for key in keys if rows[0]["settings"].get(key) != rows[1]["settings"].get(key)}
    check(different <= marked and not (keys - different) & marked, "exactly the keys that differ are marked")
    return both


def try_selection(driver, data):
    plot = driver.find_element(By.CSS_SELECTOR, "#scatter .nsewdrag")
    width, height = plot.size["width"], plot.size["height"]
    # A box around the left half.
    ActionChains(driver).move_to_element_with_offset(plot, -width // 2 + 3, -height // 2 + 3).click_and_hold() \
        .move_by_offset(width // 4, height // 2).move_by_offset(width // 4, height // 2 - 8).release().perform()
    settle()
    count = int(re.match(r"(\d+) selected", driver.find_element(By.ID, "selected").text)[1])
    grey, selected, front = colours(driver)
    check(0 < count < len(data["rows"]), f"a box selects designs, {count}")
    check(selected + front == count and grey > 0, "only their lines are coloured in the parallel coordinates")
    driver.find_element(By.ID, "clear").click()
    settle()
    check(colours(driver)[0] == 0, "Clear selection")


def try_brush(driver):
    """Marks the lower half of the first parallel axis."""
    axis = driver.find_elements(By.CSS_SELECTOR, "#parallel .axis-brush .background")[0]
    box = driver.execute_script("const r = arguments[0].getBoundingClientRect(); return [r.left + r.width / 2, r.top, r.height]", axis)
    x, bottom = int(box[0]), int(box[1] + box[2] * 0.97)
    drag = ActionChains(driver, duration=100)
    drag.w3c_actions.pointer_action.move_to_location(x, bottom)
    drag.w3c_actions.pointer_action.pointer_down()
    for share in (0.9, 0.75, 0.6):
        drag.w3c_actions.pointer_action.move_to_location(x, int(box[1] + box[2] * share))
    drag.w3c_actions.pointer_action.pointer_up()
    drag.perform()
    settle()
    expected, selected = driver.execute_script("""
        const trace = document.getElementById("parallel").data[0], axis = trace.dimensions[0];
        if (!axis.constraintrange) return [0, -1];
        const within = (v) => axis.constraintrange[0] <= v && v <= axis.constraintrange[1];
        const marks = document.getElementById("scatter").data.filter((t) => t.mode === "markers");
        return [Array.from(axis.values).filter(within).length, marks.reduce((n, t) => n + t.selectedpoints.length, 0)];""")
    check(expected == selected > 0, f"a range on a parallel axis selects designs in the plot, {selected} of {expected}")
    driver.find_element(By.ID, "clear").click()
    settle()


def main():
    page = Path(sys.argv[1]).resolve()
    driver = open_browser()
    try:
        driver.set_script_timeout(60)
        seconds, complete = min(open_page(driver, page.as_uri()) for _ in range(5))
        data = driver.execute_script("return data")
        check(seconds < LONGEST_OPENING, f"{len(data['rows'])} runs open in {seconds:.2f} s, with the parallel coordinates in {complete:.2f} s; load {os.getloadavg()[0]:.1f}")
        check(requests(driver) == [], "nothing is fetched")
        names = [column["name"] for column in data["columns"]]
        scene = [row for row in data["rows"] if row["cells"][1] == data["scenes"][0]]
        on_front = sum(row["cells"][names.index("front")] for row in scene)
        check(len(points(driver, front=True)) == on_front > 1, f"the front is drawn, {on_front} designs")
        try_selection(driver, data)
        try_brush(driver)
        driver.find_element(By.ID, "front_only").click()
        settle()
        check(sum(colours(driver)) == on_front, "front only")
        driver.find_element(By.ID, "front_only").click()
        settle()
        both = try_clicks(driver, data)
        address = driver.current_url
        check(address.endswith(f"#runs={both[0]},{both[1]}"), "the address names the designs")
        driver.get("about:blank")
        open_page(driver, address)
        check(driver.execute_script("return chosen") == both, "the address opens them again")
        if len(sys.argv) > 2:
            driver.execute_script("window.scrollTo(0, 0)")
            settle()
            driver.save_screenshot(sys.argv[2])
            driver.execute_script("document.getElementById('details').scrollIntoView()")
            settle()
            driver.save_screenshot(sys.argv[2].replace(".png", "_details.png"))
        errors = [entry["message"] for entry in driver.get_log("browser") if entry["level"] == "SEVERE"]
        check(errors == [], f"no errors in the browser's console {errors}")
    finally:
        driver.quit()
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
