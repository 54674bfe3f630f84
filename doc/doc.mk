# doc.mk - the documents: their figures, commands, names and equations.

# The figures, by doc/figures.c; a test compares them.
figures: $O/figures
	$O/figures doc/figures

$O/figures: $O/doc/figures.o $O/program/plot.o $O/program/output.o $(CORE:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

check-documents: $O/figures $O/bbm experiments
	@O=$O sh doc/check.sh

# The recipes with other tools, as far as they are installed; mpirun refuses to work for root unasked.
check-recipes: $O/bbm
	@rm -rf out/recipes && mkdir -p out && cp -r doc/recipes out
	@OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
	awk -v PROGRAMS='$(abspath $O)' -f tests/recipes.awk doc/recipes.md

.PHONY: figures check-documents check-recipes
