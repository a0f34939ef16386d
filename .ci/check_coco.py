"""Reads an exported data set as its users do, with pycocotools alone, and checks what they rely on.

usage: check_coco.py DIR [--frames N]
Ends with a line of figures; exit status 1 when anything is wrong.
"""
import argparse
import json
import os
import sys

import numpy as np
from PIL import Image
from pycocotools import mask as masks
from pycocotools.coco import COCO

arguments = argparse.ArgumentParser()
arguments.add_argument("dir")
arguments.add_argument("--frames", type=int)
options = arguments.parse_args()

faults = []
annotation_file = os.path.join(options.dir, "coco", "annotations.json")
coco = COCO(annotation_file)
data = json.load(open(annotation_file))
person = next(c for c in data["categories"] if c["name"] == "person")
if len(person["keypoints"]) != 17 or len(person["skeleton"]) != 19:
    faults.append("the category person lacks keypoints or skeleton")
if options.frames is not None and len(data["images"]) != options.frames:
    faults.append(f"{len(data['images'])} images, expected {options.frames}")
ids = [a["id"] for a in data["annotations"]]
if len(set(ids)) != len(ids) or max(ids, default=0) >= 2**53:
    faults.append("annotation ids repeat or do not fit int53")

loose, visible, off_mask, worst_projection = 0, 0, 0, 0.0
for image in data["images"]:
    picture = np.asarray(Image.open(os.path.join(options.dir, image["file_name"])))
    if picture.shape[:2] != (image["height"], image["width"]):
        faults.append(f"{image['file_name']} has size {picture.shape[:2]}")
    if picture.std() < 8:
        faults.append(f"{image['file_name']} shows nothing")
    taken = np.zeros(picture.shape[:2], bool)
    k_matrix = np.array(image["figurant"]["K"])
    for annotation in coco.loadAnns(coco.getAnnIds(image["id"])):
        name = f"annotation {annotation['id']}"
        mask = masks.decode(annotation["segmentation"]).astype(bool)
        if mask.sum() != annotation["area"] or not mask.any():
            faults.append(f"{name}: area {annotation['area']}, mask {mask.sum()}")
            continue
        if (taken & mask).any():
            faults.append(f"{name}: its mask overlaps another")
        taken |= mask
        rows, columns = np.where(mask)
        tight = np.array([columns.min(), rows.min(), columns.max() + 1, rows.max() + 1])
        x, y, w, h = annotation["bbox"]
        outside = np.array([tight[0] - x, tight[1] - y, x + w - tight[2], y + h - tight[3]])
        if outside.min() < -1e-6:
            faults.append(f"{name}: its box cuts its mask by {-outside.min():.3f} px")
        loose += outside.max() > 1.0
        points = np.array(annotation["keypoints"]).reshape(17, 3)
        space = np.array(annotation["figurant"]["keypoints_3d"])
        if annotation["num_keypoints"] != (points[:, 2] > 0).sum():
            faults.append(f"{name}: num_keypoints {annotation['num_keypoints']}")
        for (u, v, flag), p in zip(points, space):
            if flag == 0:
                if (u, v) != (0, 0):
                    faults.append(f"{name}: a keypoint with v = 0 at {u}, {v}")
                continue
            q = k_matrix @ p
            worst_projection = max(worst_projection, np.hypot(q[0] / q[2] - u, q[1] / q[2] - v))
            if flag == 2:
                visible += 1
                c, r = int(u), int(v)
                off_mask += not mask[max(0, r - 2):r + 3, max(0, c - 2):c + 3].any()

people = len(data["annotations"])
if loose > 0.02 * people + 1:
    faults.append(f"{loose} of {people} boxes are more than a pixel wider than their mask")
if off_mask > 0.01 * max(visible, 1):
    faults.append(f"{off_mask} of {visible} visible keypoints are off their mask")
if worst_projection > 0.01:
    faults.append(f"K X differs from a keypoint by {worst_projection:.4f} px")
if people < len(data["images"]):
    faults.append(f"only {people} people in {len(data['images'])} images")
for fault in faults[:30]:
    print("FAULT", fault)
print(f"{len(data['images'])} images, {people} people, {loose} loose boxes, "
      f"{off_mask} of {visible} visible keypoints off their mask, "
      f"K X within {worst_projection:.5f} px, {len(faults)} faults")
sys.exit(bool(faults))
