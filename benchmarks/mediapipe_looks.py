"""MediaPipe's own Python run of the large pose network, at as many pictures a second as Keymark looks at.

Usage: mediapipe_looks.py CLIP LOOKS_A_SECOND, by any Python that has `mediapipe` 0.10 and OpenCV.
"""

import sys

import cv2
import mediapipe


def main(clip: str, looks_a_second: str) -> None:
    """Look at a clip from its first frame to its last."""
    capture = cv2.VideoCapture(clip)
    every = max(1, round(capture.get(cv2.CAP_PROP_FPS) / float(looks_a_second)))
    number = found = 0
    with mediapipe.solutions.pose.Pose(model_complexity=2) as pose:
        while capture.grab():
            if number % every == 0:
                picture = cv2.cvtColor(capture.retrieve()[1], cv2.COLOR_BGR2RGB)
                found += pose.process(picture).pose_landmarks is not None
            number += 1
    if not found:
        raise SystemExit(f"{clip}: nobody was found")


if __name__ == "__main__":
    main(*sys.argv[1:])
