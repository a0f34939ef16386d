"""Opens the real window on a virtual screen and looks at it as a person would.

Holds: it opens, shows the exporter's picture with its controls around it, goes to the next frame
by a key, rests when nothing happens, ends well when it is closed, and says what is wrong where there
is no screen. Needs Xvfb, xdotool and ImageMagick; numpy and Pillow.
"""

import argparse
import io
import os
import subprocess
import sys
import time

import numpy as np
from PIL import Image

SIZE = (1280, 800)
# Longest wait for anything, seconds; a machine of software graphics is slow when it is busy.
PATIENCE_S = 60
# Share of one processor that a window at rest may take.
IDLE_SHARE = 0.03


def start_screen():
    read, write = os.pipe()
    screen = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24", "-nolisten", "tcp"],
        pass_fds=[write],
        stderr=subprocess.DEVNULL,
    )
    os.close(write)
    with os.fdopen(read) as told:
        number = told.readline().strip()
    assert number, "Xvfb did not start"
    display = f":{number}"
    # The number is told a moment before it can be used.
    answers = lambda: probe(display) or None
    wait_for("the screen", answers, screen)
    return screen, display


def probe(display):
    query = ["xdotool", "getdisplaygeometry"]
    env = dict(os.environ, DISPLAY=display)
    return subprocess.run(query, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0


def screenshot(env):
    png = subprocess.run(
        ["import", "-silent", "-window", "root", "png:-"], env=env, stdout=subprocess.PIPE, check=True
    )
    return np.asarray(Image.open(io.BytesIO(png.stdout)).convert("RGB")).astype(np.int16)


def colours_of(shot):
    shot = shot.astype(np.int32)
    return len(np.unique(shot[..., 0] << 16 | shot[..., 1] << 8 | shot[..., 2]))


# A screenshot holds up the whole screen, so that looking more often would slow what is waited for.
def wait_for(what, ready, process=None, pause_s=0.5):
    start = time.monotonic()
    while True:
        found = ready()
        if found is not None:
            return found, time.monotonic() - start
        assert process is None or process.poll() is None, f"it ended while waiting for {what}"
        assert time.monotonic() - start < PATIENCE_S, f"waited too long for {what}"
        time.sleep(pause_s)


def distance_to(shot, picture):
    """Mean difference, steps of 255, between a picture and where it is best seen on the screen."""
    # The picture fills the height of its pane or its width; both are tried around where it must be.
    best = 255.0
    small = np.asarray(picture.resize((64, 64), Image.BOX)).astype(np.int16)
    for side in range(500, 800, 4):
        for left in (0, (986 - side) // 2):
            for top in range(0, 12, 4):
                if top + side > SIZE[1] or left < 0:
                    continue
                cut = Image.fromarray(shot[top : top + side, left : left + side].astype(np.uint8))
                cut = np.asarray(cut.resize((64, 64), Image.BOX)).astype(np.int16)
                best = min(best, float(np.abs(cut - small).mean()))
    return best


def cpu_ticks(pid):
    fields = open(f"/proc/{pid}/stat").read().rsplit(")", 1)[1].split()
    return int(fields[11]) + int(fields[12])


def frames(program, config, folder):
    pictures = []
    for frame in (0, 1):
        out = f"{folder}/frame-{frame}.png"
        subprocess.run([program, "frame", config, "--frame", str(frame), "--out", out], check=True)
        pictures.append(Image.open(out).convert("RGB"))
    return pictures


def check(args):
    pictures = frames(args.program, args.config, args.out)
    screen, display = start_screen()
    env = dict(os.environ, DISPLAY=display)
    env.pop("WAYLAND_DISPLAY", None)
    key = lambda *keys: subprocess.run(["xdotool", "key", *keys], env=env, check=True)
    window = subprocess.Popen([args.program, args.config], env=env)
    try:
        blank = screenshot(env)

        def drawn():
            shot = screenshot(env)
            return shot if colours_of(shot) > 8 else None

        _, opened_s = wait_for("the window", drawn, window, 0.5)
        found = subprocess.run(
            ["xdotool", "search", "--onlyvisible", "--name", "Figurant"], env=env, stdout=subprocess.PIPE, check=True
        )
        ident = found.stdout.decode().split()[0]
        # There is no window manager that would give it the keys.
        subprocess.run(["xdotool", "windowfocus", ident], env=env, check=True)

        def shows(picture):
            shot = screenshot(env)
            return shot if distance_to(shot, picture) < 6.0 else None

        # Without overlays, so that the picture is the exporter's.
        subprocess.run(["xdotool", "mousemove", "1270", "400"], env=env, check=True)
        key("b")
        key("k")
        first, shown_s = wait_for("the first frame", lambda: shows(pictures[0]), window)
        assert (first != blank).any()
        key("space")
        wait_for("the second frame", lambda: shows(pictures[1]), window)
        key("b")
        key("k")
        key("shift+space")
        time.sleep(3.0)
        ticks, start = cpu_ticks(window.pid), time.monotonic()
        time.sleep(5.0)
        share = (cpu_ticks(window.pid) - ticks) / os.sysconf("SC_CLK_TCK") / (time.monotonic() - start)
        last = screenshot(env)
        Image.fromarray(last.astype(np.uint8)).save(f"{args.out}/window.png")
        colours = colours_of(last)
        print(f"window: drawn after {opened_s:.2f} s, its picture {shown_s:.2f} s later, {colours} colours")
        print(f"window: {share:.2%} of a processor at rest")
        assert colours > 5000, "the window is all but empty"
        assert share < IDLE_SHARE, f"a window at rest takes {share:.1%} of a processor"
        key("space")
        key("ctrl+q")
        status = window.wait(timeout=PATIENCE_S)
        assert status == 0, f"a window that was closed ended with {status}"
    finally:
        window.kill()
        window.wait()
        screen.terminate()
        screen.wait()


def check_no_screen(args):
    env = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET")}
    ended = subprocess.run([args.program, args.config], env=env, stderr=subprocess.PIPE, timeout=PATIENCE_S)
    text = ended.stderr.decode()
    assert ended.returncode == 3, (ended.returncode, text)
    assert "no window can be opened" in text and "export" in text, text
    assert "panicked" not in text, text
    print("window: without a screen:", text.strip().splitlines()[-1])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("config")
    parser.add_argument("--out", required=True, help="folder of the screenshot")
    args = parser.parse_args()
    check_no_screen(args)
    check(args)


if __name__ == "__main__":
    sys.exit(main())
