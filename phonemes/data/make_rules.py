#!/usr/bin/env python3
"""Makes letters.txt: rules from letters to phones, learned from the CMU dictionary.

    python3 make_rules.py cmudict.dict [HOLD_OUT] > letters.txt

Letters are aligned with phones by expectation maximisation (each letter is silent, or one or two
phones); then each letter's context grows as in IGTree (Daelemans and van den Bosch, 1997), by one
letter at a time, right and left in turn, and a rule is kept where it mends at least GAIN words.
HOLD_OUT names a file of words to leave out, so that the rules can be judged by them.
"""
import collections, math, re, sys

ORDER = [1, -1, 2, -2, 3, -3, 4, -4, 5]   # places looked at, in order
GAIN = 3

def words(path, hold_out):
    for line in open(path, encoding="utf-8"):
        fields = line.split("#")[0].split()
        if not fields or not re.fullmatch("[a-z]{2,}", fields[0]) or fields[0] in hold_out:
            continue
        if len(fields) - 1 > 1.6 * len(fields[0]):
            continue                      # spelled letter by letter
        phones = []
        for phone in fields[1:]:
            # So that a vowel's letter has the vowel and `r` is always R; who says the word drops
            # an R after ER.
            phones += [phone, "R"] if phone.startswith("ER") else [phone]
        yield fields[0], phones

def align(word, phones, cost):
    n, m = len(word), len(phones)
    best = [[math.inf] * (m + 1) for _ in range(n + 1)]
    step = [[0] * (m + 1) for _ in range(n + 1)]
    best[0][0] = 0
    for i in range(n):
        letter = word[i]
        row, nxt, stp = best[i], best[i + 1], step[i + 1]
        for j in range(m + 1):
            b = row[j]
            if b == math.inf:
                continue
            for k in (0, 1, 2):
                if j + k > m:
                    break
                c = b + cost(letter, tuple(phones[j:j + k]))
                if c < nxt[j + k] or (c == nxt[j + k] and k < stp[j + k]):
                    nxt[j + k], stp[j + k] = c, k
    if best[n][m] == math.inf:
        return None
    cuts, j = [], m
    for i in range(n, 0, -1):
        k = step[i][j]
        cuts.append(tuple(phones[j - k:j]))
        j -= k
    return cuts[::-1]

def bare(unit):
    return tuple(p.rstrip("012") for p in unit)

def train(lexicon):
    # At first any phone that often stands near a letter is likely.
    counts = collections.defaultdict(collections.Counter)
    for word, phones in lexicon[::3]:
        for i, letter in enumerate(word):
            j = i * len(phones) // len(word)
            for unit in {(), *[tuple(phones[a:a + 1]) for a in (j - 1, j, j + 1) if 0 <= a < len(phones)]}:
                counts[letter][bare(unit)] += 1
    for turn in range(4):
        totals = {l: sum(c.values()) for l, c in counts.items()}
        memo = {}
        def cost(letter, unit):
            key = (letter, unit)
            if key not in memo:
                n = counts[letter][bare(unit)]
                # Whole numbers, so that equal ways are equal: the earlier letter then has the phone.
                memo[key] = round(-1000 * math.log((n + 0.01) / totals[letter]))
                memo[key] += 4000 if len(unit) == 2 and turn == 0 else 0
            return memo[key]
        part = lexicon if turn == 3 else lexicon[turn::4]
        new = collections.defaultdict(collections.Counter)
        aligned = []
        for word, phones in part:
            cuts = align(word, phones, cost)
            if cuts is None:
                continue
            aligned.append((word, cuts))
            for letter, unit in zip(word, cuts):
                new[letter][bare(unit)] += 1
        counts = new
    return aligned

def context(word, i, depth):
    out = word[i]
    for at in ORDER[:depth]:
        out += word[i + at] if 0 <= i + at < len(word) else "-"
    return out

def grow(cases, key, depth, inherited, rules):
    counts = collections.Counter(unit for _, _, unit in cases)
    unit, n = min(counts.items(), key=lambda c: (-c[1], c[0]))
    if inherited is None or n - counts[inherited] >= GAIN:
        rules[key] = inherited = unit
    if depth == len(ORDER) or len(cases) - counts[inherited] < GAIN:
        return
    parts = collections.defaultdict(list)
    at = ORDER[depth]
    for case in cases:
        word, i, _ = case
        parts[word[i + at] if 0 <= i + at < len(word) else "-"].append(case)
    for letter, part in parts.items():
        grow(part, key + letter, depth + 1, inherited, rules)

def main():
    hold_out = set(open(sys.argv[2]).read().split()) if len(sys.argv) > 2 else set()
    aligned = train(list(words(sys.argv[1], hold_out)))
    cases = collections.defaultdict(list)
    for word, cuts in aligned:
        for i, unit in enumerate(cuts):
            cases[word[i]].append((word, i, unit))
    rules = {}
    for letter in sorted(cases):
        grow(cases[letter], letter, 0, None, rules)
    for key in sorted(rules):
        print(key, *rules[key])

if __name__ == "__main__":
    main()
