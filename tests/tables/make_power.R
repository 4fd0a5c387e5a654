# Power and sample sizes by R's own functions. Run in this folder: Rscript make_power.R
out <- file("power.csv", "w")
writeLines("# Rscript tests/tables/make_power.R", out)
writeLines("method,alpha,n,m,effect,two_sided,power", out)
row <- function(method, alpha, n, m, effect, two_sided, power)
  writeLines(sprintf("%s,%.17g,%g,%g,%.17g,%d,%.17g", method, alpha, n, m, effect, two_sided, power), out)
for (alpha in c(0.05, 0.01, 1e-4)) for (n in c(5, 20, 200)) for (d in c(0.1, 0.5, 1.5)) {
  for (side in c("two.sided", "one.sided")) {
    one <- power.t.test(n = n, delta = d, sig.level = alpha, type = "one.sample",
                        alternative = side, strict = TRUE)$power
    two <- power.t.test(n = n, delta = d, sig.level = alpha, type = "two.sample",
                        alternative = side, strict = TRUE)$power
    row("student_t", alpha, n, 0, d, as.integer(side == "two.sided"), one)
    row("welch", alpha, n, n, d, as.integer(side == "two.sided"), two)
  }
  row("chi_square_fit", alpha, n * 20, 15, d / 2, 0,
      pchisq(qchisq(alpha, 15, lower.tail = FALSE), 15, ncp = n * 20 * (d / 2)^2, lower.tail = FALSE))
}
close(out)
