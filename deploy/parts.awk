# What a root file system's packages weigh, by why they are there: each package counts for the smallest of the roots that
# need it, so that a root's line says what would go with it.
#   awk -v base="PACKAGE..." -v roots="PACKAGE..." -f parts.awk < LIST
# A line of LIST has semicolons between a package's name, its files' bytes, what it provides, and what it depends on. Prints MB (10⁶).
BEGIN { FS = ";" }
{
  bytes[$1] = $2
  provider[$1] = $1
  needs[$1] = $4
  for (i = split($3, names, /, */); i > 0; --i) {
    sub(/ .*/, "", names[i])
    if (names[i] != "" && !(names[i] in provider)) provider[names[i]] = $1
  }
}

# Marks in `seen` what `package` needs, itself included; of alternatives the first that is there.
function reach(package, seen,    clauses, count, choices, i, j, name) {
  if (package in seen) return
  seen[package] = 1
  count = split(needs[package], clauses, /, */)
  for (i = 1; i <= count; ++i) {
    gsub(/ *\([^)]*\)|:any|^ +/, "", clauses[i])
    split(clauses[i], choices, / *\| */)
    for (j = 1; j in choices; ++j) {
      name = choices[j]
      sub(/ +$/, "", name)
      if (name in provider) {
        reach(provider[name], seen)
        break
      }
    }
  }
}

function weight(set,    name, sum) {
  for (name in set) if (!(name in counted)) sum += bytes[name]
  return sum
}

# Counts what is in `set` and was not yet counted, and prints a line of it.
function count_part(set, title,    name, sum, packages) {
  for (name in set) {
    if (name in counted || !(name in bytes)) continue
    counted[name] = 1
    sum += bytes[name]
    ++packages
  }
  if (!packages) return
  total += sum
  printf "%7.1f %8d  %s\n", sum / 1e6, packages, title
}

END {
  print "     MB packages  part"
  split(base, names, / +/)
  for (i in names) in_base[names[i]] = 1
  count_part(in_base, "Debian itself")
  for (left = split(roots, waiting, / +/); left > 0; --left) {
    lightest = 0
    for (i in waiting) {
      delete set
      reach(waiting[i], set)
      now = weight(set)
      if (!lightest || now < least) { lightest = i; least = now }
    }
    delete set
    reach(waiting[lightest], set)
    count_part(set, waiting[lightest])
    delete waiting[lightest]
  }
  for (name in bytes) if (!(name in counted)) rest[name] = 1
  count_part(rest, "other packages")
  printf "%7.1f %8s  all packages\n", total / 1e6, ""
}
