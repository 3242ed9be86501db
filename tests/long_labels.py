"""Prints TIMIT labels that last so many minutes: the sentences of fixtures/sentences in turn.

For what an hour needs: python3 tests/long_labels.py 60 > hour.PHN, then
/usr/bin/time -v target/release/mouthpiece curves --labels hour.PHN --rate 60 -o hour.csv
"""

import glob
import os
import sys

RATE = 16_000


def main():
    minutes = float(sys.argv[1])
    folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "fixtures", "sentences")
    files = sorted(glob.glob(os.path.join(folder, "*.PHN")))
    offset = 0
    while True:
        for file in files:
            with open(file) as lines:
                labels = [line.split() for line in lines]
            for start, end, phone in labels:
                if offset + int(end) > minutes * 60 * RATE:
                    return
                print(offset + int(start), offset + int(end), phone)
            offset += int(labels[-1][1])


if __name__ == "__main__":
    main()
