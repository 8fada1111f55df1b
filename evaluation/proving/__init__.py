"""The proving ground: recordings whose cause is known, made by code that shares nothing with the units."""
