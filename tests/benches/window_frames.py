"""Counts the frames that the real window draws while it computes pictures.

    python3 tests/benches/window_frames.py PROGRAM [CONFIG] [--engine native|graphics] [--seconds N]

The pointer moves all the time, so that the window is to be drawn as often as it can, first while
nothing is computed, then while every quarter of a second the next frame is asked for. Each drawing is
reported by the X server (its DAMAGE extension), so that nothing is asked of the program. Needs Xvfb,
xdotool and ImageMagick; python-xlib, numpy and Pillow.
"""

import argparse
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

from Xlib import X, display
from Xlib.ext import damage, xtest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / ".ci"))

from check_window import colours_of, screenshot, start_screen, wait_for  # noqa: E402

# Seconds until shaders are compiled and the first pictures are made.
WARM_UP_S = 6
SPACE = 0x20


def every(pause_s, stop, act):
    turn = 0
    while not stop.wait(pause_s):
        act(turn)
        turn += 1


def drawings(screen, window, seconds, computes):
    """When the window was drawn, seconds, while the pointer moves."""
    watch, hand = display.Display(screen), display.Display(screen)
    watch.damage_query_version()
    drawable = watch.create_resource_object("window", window)
    report = drawable.damage_create(damage.DamageReportNonEmpty)

    def move(turn):
        xtest.fake_input(hand, X.MotionNotify, x=1050 + turn * 7 % 200, y=400 + turn * 3 % 200)
        hand.flush()

    def next_frame(_):
        for event in (X.KeyPress, X.KeyRelease):
            xtest.fake_input(keys, event, keys.keysym_to_keycode(SPACE))
        keys.flush()

    keys, stop = display.Display(screen), threading.Event()
    acts = [(0.01, move)] + ([(0.25, next_frame)] if computes else [])
    threads = [threading.Thread(target=every, args=(pause, stop, act)) for pause, act in acts]
    for thread in threads:
        thread.start()
    times, end = [], time.monotonic() + seconds
    while time.monotonic() < end:
        while watch.pending_events():
            if watch.next_event().type == watch.extension_event.DamageNotify:
                times.append(time.monotonic())
                watch.damage_subtract(report)
        time.sleep(0.002)
    stop.set()
    for thread in threads:
        thread.join()
    return times


def line(what, times, seconds):
    gaps = sorted(later - earlier for earlier, later in zip(times, times[1:]))
    at = lambda share: gaps[min(int(len(gaps) * share), len(gaps) - 1)] * 1e3
    rate = len(times) / seconds
    return f"{what:<24}{rate:6.1f} frames/s; between two {at(0.5):.0f} ms, 95 % {at(0.95):.0f}, most {at(1):.0f}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("config", nargs="?", default=str(ROOT / "presets/peoplesanspeople.json"))
    parser.add_argument("--engine", choices=["native", "graphics"], default="native")
    parser.add_argument("--seconds", type=float, default=10.0)
    args = parser.parse_args()
    server, screen = start_screen()
    env = dict(os.environ, DISPLAY=screen)
    env.pop("WAYLAND_DISPLAY", None)
    run = lambda *words: subprocess.run(words, env=env, stdout=subprocess.PIPE, check=True).stdout.decode()
    window = subprocess.Popen([args.program, args.config], env=env)
    try:
        wait_for("the window", lambda: colours_of(screenshot(env)) > 8 or None, window)
        ident = run("xdotool", "search", "--onlyvisible", "--name", "Figurant").split()[0]
        run("xdotool", "windowfocus", ident)
        time.sleep(WARM_UP_S)
        if args.engine == "graphics":
            # On a machine without hardware the native engine is what the window begins with.
            run("xdotool", "key", "g")
            time.sleep(WARM_UP_S)
        for what, computes in [("at rest", False), ("while pictures are made", True)]:
            print(line(what, drawings(screen, int(ident), args.seconds, computes), args.seconds))
            time.sleep(1)
    finally:
        window.terminate()
        window.wait()
        server.terminate()


if __name__ == "__main__":
    main()
