"""Whether detectors trained on real people find ours.

OpenCV's HOG detector of pedestrians (Dalal and Triggs 2005, trained on INRIA's photographs) looks for
those who stand or walk, its cascade of frontal faces (Viola and Jones 2001, Lienhart's training) for
faces whose nose can be seen.

    check_people.py FOLDER_OF_PEOPLE FOLDER_OF_FACES
"""

import json
import pathlib
import sys

import cv2

# Activities in which people are as upright as pedestrians are.
UPRIGHT = {"standing", "walking", "carrying", "pointing", "reading", "phoning", "waving"}
# Shares that must be found.
PEOPLE, FACES = 0.9, 0.85


def annotated(folder):
    """Pictures of a data set with their annotations."""
    folder = pathlib.Path(folder)
    coco = json.loads((folder / "coco" / "annotations.json").read_text())
    of = {image["id"]: [] for image in coco["images"]}
    for annotation in coco["annotations"]:
        of[annotation["image_id"]].append(annotation)
    for image in coco["images"]:
        name = pathlib.Path(image["file_name"]).name
        yield cv2.imread(str(folder / "images" / name)), of[image["id"]]


def overlap(a, b):
    """Intersection over union of two boxes."""
    across = min(a[0] + a[2], b[0] + b[2]) - max(a[0], b[0])
    down = min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1])
    both = max(across, 0) * max(down, 0)
    return both / (a[2] * a[3] + b[2] * b[3] - both)


def people(folder):
    """How many of those who are upright were found, and how many there are."""
    hog = cv2.HOGDescriptor()
    hog.setSVMDetector(cv2.HOGDescriptor_getDefaultPeopleDetector())
    found = all_of_them = 0
    for picture, annotations in annotated(folder):
        small = cv2.resize(picture, None, fx=0.5, fy=0.5)
        upright = [a for a in annotations if a["figurant"]["person"]["activity"] in UPRIGHT]
        if not upright:
            continue
        boxes, _ = hog.detectMultiScale(small, winStride=(4, 4), padding=(16, 16), scale=1.05)
        # The detector's windows have a margin.
        tight = [(x + 0.12 * w, y + 0.06 * h, 0.76 * w, 0.88 * h) for x, y, w, h in boxes]
        for annotation in upright:
            box = [0.5 * v for v in annotation["bbox"]]
            all_of_them += 1
            found += any(overlap(b, box) > 0.4 for b in tight)
    return found, all_of_them


def faces(folder):
    """How many faces were found whose nose can be seen, and how many there are."""
    cascade = cv2.CascadeClassifier(cv2.data.haarcascades + "haarcascade_frontalface_alt2.xml")
    found = all_of_them = 0
    for picture, annotations in annotated(folder):
        grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
        boxes = cascade.detectMultiScale(grey, 1.05, 4, minSize=(30, 30))
        for annotation in annotations:
            x, y, v = annotation["keypoints"][:3]
            if v == 2:
                all_of_them += 1
                found += any(a < x < a + w and b < y < b + h for a, b, w, h in boxes)
    return found, all_of_them


def main():
    """Both, against the shares that must be found."""
    enough = True
    for name, (found, total), share in [
        ("upright people", people(sys.argv[1]), PEOPLE),
        ("faces", faces(sys.argv[2]), FACES),
    ]:
        print(f"{name}: {found} of {total} found by a detector trained on real ones")
        enough &= total >= 30 and found >= share * total
    sys.exit(0 if enough else f"fewer than {PEOPLE:.0%} of people or {FACES:.0%} of faces found")


main()
