# Tests of two samples of unequal size, and of one, by R's own functions. Run in this folder:
# Rscript make_unequal.R
# Samples: sums of twelve uniforms of Lehmer's generator 16807 s mod 2^31 - 1, exact in doubles, less 6;
# seeds are 1000 k for the first and 1000 k + 1 for the second; the second is scaled and shifted.
# R takes the exact p-value of Kolmogorov and Smirnov from 1, so that small ones lose digits: none is.
sums <- function(seed, count) {
  values <- numeric(count)
  for (i in seq_len(count)) {
    sum <- 0
    for (j in 1:12) {
      seed <- (16807 * seed) %% 2147483647
      sum <- sum + seed / 2147483647
    }
    values[i] <- sum - 6
  }
  values
}
options(warn = 2)
counts <- function(values) as.vector(table(cut(values, c(-Inf, -1, -0.25, 0.5, 1.25, Inf))))
out <- file("unequal.csv", "w")
writeLines("# Rscript tests/tables/make_unequal.R", out)
writeLines(paste0("k,n,m,scale,shift,t,t_p,chi,chi_p,welch,welch_nu,welch_p,welch_less,f,f_p,f_greater,",
                  "ks,ks_p,cells,cells_p"), out)
cases <- list(c(400, 250, 1, 0), c(400, 250, 1.25, 0.25), c(250, 400, 1, -0.125), c(431, 257, 1, 0.125),
              c(180, 1200, 1.25, 0.125), c(620, 210, 0.875, 0.125))
for (k in seq_along(cases)) {
  case <- cases[[k]]
  x <- sums(1000 * k, case[1])
  y <- sums(1000 * k + 1, case[2]) * case[3] + case[4]
  t <- t.test(x, mu = 0.0625)
  chi <- (length(x) - 1) * var(x) / 1.1
  welch <- t.test(x, y)
  f <- var.test(x, y)
  ks <- ks.test(x, y, exact = TRUE)
  cells <- chisq.test(rbind(counts(x), counts(y)), correct = FALSE)
  numbers <- c(t$statistic, t$p.value, chi, 2 * min(pchisq(chi, length(x) - 1),
               pchisq(chi, length(x) - 1, lower.tail = FALSE)),
               welch$statistic, welch$parameter, welch$p.value, t.test(x, y, alternative = "less")$p.value,
               f$statistic, f$p.value, var.test(x, y, alternative = "greater")$p.value,
               ks$statistic, ks$p.value, cells$statistic, cells$p.value)
  stopifnot(all(cells$expected >= 20), length(unique(c(x, y))) == length(c(x, y)))
  writeLines(paste(c(k, case, sprintf("%.17g", numbers)), collapse = ","), out)
}
close(out)
