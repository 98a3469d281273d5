# SPDX-License-Identifier: Apache-2.0
# A CSV of scores as a plot of text: 72 columns of time, 12 rows from 0 to the highest score.
NR == 1 {
  for (i = 1; i <= NF; i++) column[$i] = i
  next
}
$1 == "time" { next }
{
  score[++n] = $column["score"]
  limit[n] = $column["threshold"]
}
END {
  if (n < 1) { print "(no scores)"; exit }
  width = n < 72 ? n : 72
  for (i = 1; i <= n; i++) {
    c = int((i - 1) * width / n)
    if (score[i] > top[c]) top[c] = score[i]
    if (limit[i] != "") bound[c] = limit[i]
    if (score[i] > highest) highest = score[i]
  }
  rows = 12
  for (r = rows; r >= 1; r--) {
    line = ""
    for (c = 0; c < width; c++) {
      threshold_here = (c in bound) && int(bound[c] / highest * rows) + 1 == r
      line = line (top[c] / highest * rows > r - 1 ? "#" : threshold_here ? "-" : " ")
    }
    printf "%8.1f |%s\n", highest * r / rows, line
  }
  printf "%8s +%s\n", "", substr("------------------------------------------------------------------------", 1, width)
}
