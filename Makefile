# make           builds the experiments        make check     every test (needs libcheck)
# make run       runs them: tables, pictures   make quick     the fast ones: the library's formulas and solver
# make bench     time ratios of the solver     make memcheck  the tests under valgrind
# make gallery   blocks that slide, topple, fall; the model files
# make torture   scenes that nobody has looked at, from SEED on (SCENES, TIME in seconds, KIND)
# make fuzz      arbitrary bytes for the readers of files, ten minutes (clang)
# make converge  meshes against alpha          make sanitize  the tests under ASan and UBSan

CC      ?= cc
CFLAGS  ?= -O2
STRICT   = -std=c99 -ffp-contract=off -Wall -Wextra -pedantic -Wshadow -Wconversion -Wstrict-prototypes -Wmissing-prototypes
LIBRARY  = bbm contact solver beyond/middle beyond/balance
RUN      = exp1 exp2 exp3
GALLERY  = incline shaken topple column overhang drop impact turning arch resting
CASES    = $(RUN) $(GALLERY)
SHARED   = case plot scene theory
PROGRAM  = bbm model msh write
SUITES   = check_bbm check_contact check_solver check_beyond check_motion check_bars check_theory check_equations
HEADERS  = $(wildcard *.h cases/*.h tests/*.h)
O        = out/build
FAILING  = -Dmalloc=test_malloc -Dcalloc=test_calloc -Drealloc=test_realloc -Dfree=test_free
CHECK   := $(shell pkg-config --libs check 2>/dev/null || echo -lcheck -lsubunit -lrt -lpthread)

all: $(CASES:%=$O/%) $O/bench bbm

run: $(RUN:%=$O/%)
	@for c in $(RUN); do $O/$$c || exit 1; done

gallery: $(GALLERY:%=$O/%) bbm
	@for c in $(GALLERY); do $O/$$c || exit 1; done
	@mkdir -p out/models
	@for m in cases/models/*.model; do ./bbm $$m -o out/models/$$(basename $$m .model) || exit 1; done

converge: $O/exp1 $O/exp2
	@for c in exp1 exp2; do $O/$$c converge || exit 1; done

bench: $O/bench
	@$O/bench

$(CASES:%=$O/%): $O/%: $O/cases/%.o $(SHARED:%=$O/cases/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

bbm: $O/bbm
	cp $O/bbm bbm

$O/bbm: $(PROGRAM:%=$O/cases/%.o) $(SHARED:%=$O/cases/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$O/bench: $O/tests/bench.o $(SHARED:%=$O/cases/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$O/torture: $O/tests/torture.o $O/tests/scenes.o $O/tests/ledger.o $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

torture: $O/torture
	$O/torture $(or $(SEED),1) $(or $(SCENES),0) $(or $(TIME),60) $(KIND)

$O/%.o: %.c $(HEADERS) Makefile
	@mkdir -p $(@D)
	$(CC) $(STRICT) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

# --- tests: the library once more, with an allocator that can be made to fail ---
$O/failing/%.o: %.c $(HEADERS) Makefile
	@mkdir -p $(@D)
	$(CC) $(STRICT) $(FAILING) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

$O/tests/check_cases.o $O/tests/check_model.o: CPPFLAGS += -DBUILD='"$O"'

$O/tests/check_all.o: tests/check_main.c $(HEADERS) Makefile
	@mkdir -p $(@D)
	$(CC) $(STRICT) -DCASES $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

TESTED = $(SUITES:%=$O/tests/%.o) $O/tests/test_alloc.o $O/cases/theory.o $(LIBRARY:%=$O/failing/%.o)

$O/quick: $O/tests/check_main.o $(TESTED)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(CHECK) -lm

$O/check: $O/tests/check_all.o $O/tests/check_cases.o $O/tests/check_model.o $(TESTED)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(CHECK) -lm

$(SUITES:%=$O/tests/%.o) $O/tests/check_main.o $O/tests/check_all.o $O/tests/check_cases.o $O/tests/check_model.o: | libcheck

libcheck:
	@echo '#include <check.h>' | $(CC) $(CPPFLAGS) -E - >/dev/null 2>&1 || \
	{ echo "The tests need libcheck: apt-get install check (Debian, Ubuntu), or libcheck.github.io/check"; exit 1; }

quick: $O/quick
	$O/quick

check: $O/check $(CASES:%=$O/%) $O/bbm
	$O/check

memcheck:
	$(MAKE) O=out/memcheck CPPFLAGS=-DGUARD=0 out/memcheck/quick
	CK_FORK=no valgrind -q --error-exitcode=1 --leak-check=full --errors-for-leak-kinds=definite,indirect,possible \
	out/memcheck/quick

sanitize:
	$(MAKE) O=out/sanitize CPPFLAGS=-DGUARD=0 CFLAGS="-g -O1 -fsanitize=address,undefined -fno-sanitize-recover=all" quick

fuzz:
	@mkdir -p out/corpus
	clang -std=c99 -g -O1 -fsanitize=address,undefined,fuzzer -fno-sanitize-recover=all -o out/fuzz tests/fuzz_model.c \
	cases/model.c cases/msh.c $(LIBRARY:%=%.c) -lm
	out/fuzz -max_len=4096 -timeout=100 -max_total_time=600 -artifact_prefix=out/ out/corpus tests/bad tests/mesh cases/models

clean:
	rm -rf out bbm

.PHONY: all run gallery converge bench quick check memcheck sanitize fuzz torture libcheck clean
.DELETE_ON_ERROR:
