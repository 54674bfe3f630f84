# sum.awk - the sum of what libcheck says of the parts: which tests failed, once more at the end, and
# how many checks ran and failed.
BEGIN { FS = "[:,]" }
/^[0-9]+%: Checks:/ { run += $3; failed += $5 + $7 }
/^[^ ]+:[0-9]+:[FE]:/ { print }
/^ended with status/ { bad = 1 }
END { print run " checks, " failed " failed" (bad ? ": not passed" : ""); exit bad }
