"""The database: SQLite in the data folder, or PostgreSQL by URL; one schema, made by migrations."""
