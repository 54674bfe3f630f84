# sum.awk - the sum of what libcheck says of the parts: how many checks ran, how many failed.
BEGIN { FS = "[:,]" }
/^[0-9]+%: Checks:/ { run += $3; failed += $5 + $7 }
/^ended with status/ { bad = 1 }
END { print run " checks, " failed " failed" (bad ? ": not passed" : ""); exit bad }
