# exercises.awk - the exercises of the kind predict, with their titles, from the chapters.
/^#/ { title = $0; on = 0 }
/^\| predict/ { print title; on = 1 }
on
