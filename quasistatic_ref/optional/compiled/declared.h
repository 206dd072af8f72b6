const char *digest(void);
int64_t cloud_contacts(const void *, const void *, const void *, const void *, const void *,
                       const void *, const void *, const void *, const void *, const void *,
                       const void *, const void *, const void *, const void *);
int64_t plus(const void *, const void *, const void *, const void *, const void *, const void *);
int64_t step_loads(const void *, const void *, const void *, const void *, const void *, double,
                   const void *, const void *, const void *, const void *, const void *);
int64_t form_step(const void *, const void *, const void *, const void *, const void *,
                  const void *, const void *, double, const void *, const void *, const void *,
                  const void *, const void *, const void *, const void *, const void *,
                  const void *, const void *, const void *);
int64_t natural_programs(const void *, const void *, const void *, const void *, const void *,
                         const void *, const void *, const void *, const void *, double, double,
                         const void *, const void *, const void *);
