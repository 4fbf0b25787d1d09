# shellcheck shell=bash
# Compares output with what a page of docs shows: equal but for blanks, digits beyond the sixth, the differences in a
# certificate, and times. A line `...` of the page stands for any lines. Sourced, never run.
plain() {
  LC_ALL=C awk '
    NF == 0 { next }
    $1 == "seconds" { print $1; next }
    { sub(/ worst .*/, "")
      for (i = 1; i <= NF; ++i) if ($i ~ /^-?[0-9]+\.[0-9]+(e[-+]?[0-9]+)?,?$/) $i = sprintf("%.6g", $i)
      $1 = $1
      print }' "$1"
}
# as_shown SHOWN PRINTED: whether PRINTED has exactly the lines of SHOWN, in order.
as_shown() {
  awk 'NR == FNR { shown[++n] = $0; next }
    { while (at < n && shown[at + 1] == "...") { ++at; any = 1 }
      if (at < n && shown[at + 1] == $0) { ++at; any = 0 } else if (!any) { print "  printed: " $0; exit bad = 1 } }
    END { while (!bad && at < n && shown[at + 1] == "...") ++at
      if (!bad && at < n) { print "  not printed: " shown[at + 1]; bad = 1 }
      exit bad }' <(plain "$1") <(plain "$2")
}
