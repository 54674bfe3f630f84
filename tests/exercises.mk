# exercises.mk - the exercises in the chapters of doc/: a copy of a source in out/exercise/N, and its tests.
ALONE    = $(CORE:%=$O/%.o)
EXERCISE = O="$O" FAILING="$(FAILING)" LINK="$(CC) $(CFLAGS) $(LDFLAGS)" LIBS="$(CHECK) -lm" \
           COMPILE="$(CC) $(STRICT) -Wno-unused -Wno-unused-parameter $(CPPFLAGS) $(CFLAGS) -O0" \
           TESTED="$O/tests/check_main.o $(TESTED)" ALONE="$(ALONE)" COMMON="$(COMMON:%=$O/%.o)" \
           MAKE="$(MAKE) -s" sh tests/exercise.sh

exercise:
	+@$(EXERCISE) begin $(or $(N),0)

hint:
	@sh tests/exercise.sh hint $(or $(N),0) $(or $(STEP),1)

exercises:
	@sh tests/exercise.sh list

check-exercises: check-library $O/quick $O/bbm $O/doc/exercises/own.o $(ALONE) $O/paper/exp2
	+@$(EXERCISE) prove

.PHONY: exercise hint exercises check-exercises
